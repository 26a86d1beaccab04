// SPDX-License-Identifier: Apache-2.0
// Volumes and masses of moved earth, from a comparison of the ground with its start.
#pragma once

#include <vector>

#include "heightfield/loose_soil.h"
#include "sim/world.h"

namespace navvy::record {

/// Moved mass of one soil [kg].
struct SoilMoved {
  /// Mass that left columns.
  double dug = 0;
  /// Mass that came to other columns.
  double spoil = 0;
};

/// Earth moved by digging and dumping, without wheel ruts: columns whose mass changed. Active soil
/// on a column counts as part of it. Soil in the air, a bucket or a bed was dug and is not spoil
/// yet.
struct Earthwork {
  /// Mass taken out of columns / bank density [m3].
  double bank_volume = 0;
  /// Rise of the columns that gained mass, never negative [m3].
  double loose_volume = 0;
  /// Masses by soil, in the order of the scene.
  std::vector<SoilMoved> soils;
};

/// Measures the moved earth on the surface that maps show. Costs a pass over the changed columns,
/// and one over the particles unless `lying` (sim::active_places) is given.
Earthwork measure_earthwork(const sim::World& world, const heightfield::LooseSoil& lying);
/// Measures with the loose soil of the particles, at the cost of a pass over them.
Earthwork measure_earthwork(const sim::World& world);

}  // namespace navvy::record
