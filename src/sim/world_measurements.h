// SPDX-License-Identifier: Apache-2.0
// Measurements of a world, as plain values: no solver header is included.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::sim {

/// Counters of the soil solver since the start, unless stated otherwise.
struct SoilCounts {
  std::uint64_t steps = 0;
  /// Sum of the active particles over all steps.
  std::uint64_t particle_steps = 0;
  /// Active particles now, and the largest number at once.
  int particles = 0, particles_peak = 0;
  /// Times that particles were sorted.
  std::uint64_t rebins = 0;
  /// Columns turned into particles.
  std::uint64_t activated_columns = 0;
  /// Blocks deposited into columns.
  std::uint64_t deposited_blocks = 0;
  /// Particles found on the wrong side of a shell.
  std::uint64_t shell_crossings = 0;
};

/// Entry of an energy account.
struct EnergyTerm {
  /// Name, as soil::report_energy gives it.
  std::string name;
  double joule = 0;
};

/// Energy account of active soil [docs/soil.md, energy], for readers without the solver: always the
/// same terms in the same order, the residual last.
using SoilEnergy = std::vector<EnergyTerm>;

/// Mass of the soil by place, one entry per soil of the scene, in units of kMassQuantum. Recounted
/// on demand.
struct MassLedger {
  /// Change of the ground since the start.
  std::vector<std::int64_t> columns;
  /// Active soil.
  std::vector<std::int64_t> particles;
  /// Soil that left the site over its edge.
  std::vector<std::int64_t> left_site;
  /// Soil added from outside, such as the load of a bed.
  std::vector<std::int64_t> inserted;
  /// Sum over soils of |columns + particles + left_site - inserted|; 0: closed.
  std::int64_t error = 0;
};

/// One active particle as a mass over a column of the ground.
struct ActiveParticle {
  /// Column under it; may be outside the site.
  int ix = 0, iy = 0;
  /// Index into the scene's soils.
  std::uint16_t soil = 0;
  std::int64_t mass = 0;  ///< [kMassQuantum]
};

/// Wall time of stepping so far, by part [s].
struct WallTimes {
  double vehicle = 0, soil = 0, ground = 0;
};

/// Momentum balance between tool and soil in the last step's nodal solve, summed in double
/// precision.
struct MomentumBalance {
  /// Impulse on the tool + change of the nodes' momentum [N s].
  Vec3 residual = Vec3::Zero();
  /// The same for angular momentum about the link's origin [N m s].
  Vec3 residual_moment = Vec3::Zero();
  /// Sums of the magnitudes of both; 0: no contact in this step.
  double scale = 0, scale_moment = 0;
};

}  // namespace navvy::sim
