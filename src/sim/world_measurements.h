// SPDX-License-Identifier: Apache-2.0
// Measurements of a world as plain values, which need no header of the soil solver.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::sim {

/// Counters of the soil solver. Unless stated otherwise, they count from the start of the
/// simulation.
struct SoilCounts {
  /// Number of time steps.
  std::uint64_t steps = 0;
  /// Number of active particles, summed over all steps.
  std::uint64_t particle_steps = 0;
  /// Current number of active particles, and the maximum number at any time so far.
  int particles = 0, particles_peak = 0;
  /// Number of times that the solver sorted the particles.
  std::uint64_t rebins = 0;
  /// Number of columns that were turned into particles.
  std::uint64_t activated_columns = 0;
  /// Number of particle blocks that were turned back into columns.
  std::uint64_t deposited_blocks = 0;
  /// Number of times that a particle was found on the wrong side of a tool's shell.
  std::uint64_t shell_crossings = 0;
};

/// One term of an energy account.
struct EnergyTerm {
  /// Name of the term, as soil::report_energy gives it.
  std::string name;
  /// Energy of the term [J].
  double joule = 0;
};

/// Energy account of the active soil [docs/soil.md, energy], for code that does not include the
/// soil solver. The terms and their order are always the same; the last one is the residual, which
/// the other terms do not explain.
using SoilEnergy = std::vector<EnergyTerm>;

/// Account of the soil mass. Each list has one entry per soil of the scene, in units of
/// kMassQuantum.
struct MassLedger {
  /// Mass of the soil in ground columns now, minus that at the start.
  std::vector<std::int64_t> columns;
  /// Mass of the active soil (particles) now.
  std::vector<std::int64_t> particles;
  /// Mass of the soil that has left the site over its edge.
  std::vector<std::int64_t> left_site;
  /// Mass of the soil that was added from outside, such as the initial load of a bed.
  std::vector<std::int64_t> inserted;
  /// Sum over all soils of |columns + particles + left_site - inserted|. It is 0 if no mass was
  /// gained or lost.
  std::int64_t error = 0;
};

/// One active particle as a mass above a ground column.
struct ActiveParticle {
  /// Indices of the column under the particle; they may be outside the site.
  int ix = 0, iy = 0;
  /// Index of the particle's soil in the scene's list of soils.
  std::uint16_t soil = 0;
  /// Mass of the particle in units of kMassQuantum.
  std::int64_t mass = 0;
};

/// Wall time that the steps of a world have taken so far, by part [s].
struct WallTimes {
  /// Wall time of machines, of active soil, and of ground columns [s].
  double vehicle = 0, soil = 0, ground = 0;
};

/// Check that momentum was conserved between a tool and the soil in the last step. All sums are
/// computed in double precision, in axes of W.
struct MomentumBalance {
  /// Impulse on the tool plus the change of the grid nodes' momentum [N s]; zero if momentum is
  /// conserved.
  Vec3 residual = Vec3::Zero();
  /// Same as `residual` for angular momentum about the origin of the tool's link [N m s].
  Vec3 residual_moment = Vec3::Zero();
  /// Sums of the magnitudes of the terms in `residual` [N s] and `residual_moment` [N m s], to
  /// judge the residuals by; 0 if there was no contact in the step.
  double scale = 0, scale_moment = 0;
};

}  // namespace navvy::sim
