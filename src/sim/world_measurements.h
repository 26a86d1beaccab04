// SPDX-License-Identifier: Apache-2.0
// What a world counts and measures about itself, as plain values: no solver's header is behind
// them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::sim {

/// Counts of the soil solver since the start, as far as not said otherwise.
struct SoilCounts {
  std::uint64_t steps = 0;
  std::uint64_t particle_steps = 0;       ///< sum over steps of awake particles
  int particles = 0, particles_peak = 0;  ///< awake now; most at once
  std::uint64_t rebins = 0;               ///< times that particles were sorted anew
  std::uint64_t activated_columns = 0;    ///< columns turned into particles
  std::uint64_t deposited_blocks = 0;     ///< blocks booked back into columns
  std::uint64_t shell_crossings = 0;      ///< particles found on the wrong side of a shell
};

/// One line of an account of energy.
struct EnergyTerm {
  std::string name;  ///< as soil::report_energy calls it
  double joule = 0;
};

/// Where the energy of awake soil came from and went [docs/soil.md, energy], for readers that know
/// no solver: always the same terms in the same order, the residual last.
using SoilEnergy = std::vector<EnergyTerm>;

/// Where the soil's mass is, one entry per soil of the scene, in units of kMassQuantum. Recounted
/// when asked.
struct MassLedger {
  std::vector<std::int64_t> columns;    ///< change of the ground against its start
  std::vector<std::int64_t> particles;  ///< awake
  std::vector<std::int64_t> left_site;  ///< went over the site's edge
  std::vector<std::int64_t> inserted;   ///< came in from outside, such as the load of a bed
  /// Sum over soils of |columns + particles + left_site - inserted|; 0: closed.
  std::int64_t error = 0;
};

/// One awake particle as a mass over a column of the ground.
struct ActiveParticle {
  int ix = 0, iy = 0;      ///< column it is over; may lie outside the site
  std::uint16_t soil = 0;  ///< index into the scene's soils
  std::int64_t mass = 0;   ///< [kMassQuantum]
};

/// Wall time of stepping so far, by part [s].
struct WallTimes {
  double vehicle = 0, soil = 0, ground = 0;
};

/// Proof that what a tool took, the soil gave: momentum of the last step's nodal solve, summed in
/// double.
struct MomentumBalance {
  /// Impulse on the tool + change of the nodes' momentum [N s].
  Vec3 residual = Vec3::Zero();
  /// The same of angular momentum about the link's origin [N m s].
  Vec3 residual_moment = Vec3::Zero();
  /// Sums of magnitudes behind them; 0: no contact in this step.
  double scale = 0, scale_moment = 0;
};

}  // namespace navvy::sim
