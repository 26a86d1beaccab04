// SPDX-License-Identifier: Apache-2.0
// What a world counts and measures about itself, as plain values: no solver's header is behind them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"

namespace navvy::sim {

/// Counts of the soil solver since the start, as far as not said otherwise.
struct SoilCounts {
  std::uint64_t steps = 0;
  std::uint64_t particle_steps = 0;       ///< sum over steps of awake particles
  int particles = 0, particles_peak = 0;  ///< awake now; most at once
  std::uint64_t rebins = 0;               ///< times that particles were sorted anew
  std::uint64_t woken_columns = 0;        ///< columns turned into particles
  std::uint64_t deposited_blocks = 0;     ///< blocks booked back into columns
  std::uint64_t shell_crossings = 0;      ///< particles found on the wrong side of a shell
};

/// Where the energy of awake soil came from and went [J]: soil::EnergyAccount for readers that know no solver.
struct SoilEnergy {
  double tools = 0, gravity = 0, exchanged = 0;                                       ///< supplied
  double kinetic = 0, elastic = 0;                                                    ///< kept
  double plastic = 0, viscous = 0, contact = 0, transfer = 0, mixing = 0, apart = 0;  ///< spent; `apart` is beside it
  double residual = 0;                                                                ///< supplied - kept - spent
};

/// Where the soil's mass is, one entry per soil of the scene, in units of kMassQuantum. Recounted when asked.
struct MassLedger {
  std::vector<std::int64_t> columns;    ///< change of the ground against its start
  std::vector<std::int64_t> particles;  ///< awake
  std::vector<std::int64_t> left_site;  ///< went over the site's edge
  std::vector<std::int64_t> inserted;   ///< came in from outside, such as the load of a bed
  std::int64_t error = 0;               ///< sum over soils of |columns + particles + left_site - inserted|; 0: closed
};

/// One awake particle as a mass over a column of the ground.
struct LooseSoil {
  int ix = 0, iy = 0;      ///< column it is over; may lie outside the site
  std::uint16_t soil = 0;  ///< index into the scene's soils
  std::int64_t mass = 0;   ///< [kMassQuantum]
};

/// Wall time of stepping so far, by part [s].
struct WallTimes {
  double vehicle = 0, soil = 0, ground = 0;
};

/// Proof that what a tool took, the soil gave: momentum of the last step's nodal solve, summed in double.
struct MomentumBalance {
  Vec3 residual = Vec3::Zero();         ///< impulse on the tool + change of the nodes' momentum [N s]
  Vec3 residual_moment = Vec3::Zero();  ///< the same of angular momentum about the link's origin [N m s]
  double scale = 0, scale_moment = 0;   ///< sums of magnitudes behind them; 0: no contact in this step
};

}  // namespace navvy::sim
