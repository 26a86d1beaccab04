// SPDX-License-Identifier: Apache-2.0
// How much earth was moved, from the ground as it is against the ground as it was.
#pragma once

#include <vector>

#include "heightfield/loose_soil.h"
#include "sim/world.h"

namespace navvy::record {

/// Mass of one soil that left columns and that came to others [kg].
struct SoilMoved {
  double dug = 0, spoil = 0;
};

/// Earth moved by digging and dumping, wheel ruts apart: columns whose mass changed. Soil that is
/// awake and lies on a column counts as the column's; what is in the air, a bucket or a bed has
/// been dug and is no spoil yet.
struct Earthwork {
  double bank_volume = 0;        ///< mass taken out of columns / bank density [m3]
  double loose_volume = 0;       ///< rise of the columns that gained mass, never below 0 [m3]
  std::vector<SoilMoved> soils;  ///< as the scene lists them
};
/// Of the surface that maps show. Costs a pass over the touched columns, and over the particles
/// where `lying` (sim::active_places) is not known already.
Earthwork measure_earthwork(const sim::World& world, const heightfield::LooseSoil& lying);
Earthwork measure_earthwork(const sim::World& world);

}  // namespace navvy::record
