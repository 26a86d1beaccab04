// SPDX-License-Identifier: Apache-2.0
// Volumes and masses of moved earth, from a comparison of the current ground with the initial
// ground.
#pragma once

#include <vector>

#include "heightfield/loose_soil.h"
#include "sim/world.h"

namespace navvy::record {

/// Masses of one soil that were dug and dumped [kg].
struct SoilMoved {
  /// Sum of the losses of all columns that contain less of this soil than at the start [kg].
  double dug = 0;
  /// Sum of the gains of all columns that contain more of this soil than at the start [kg].
  double spoil = 0;
};

/// Earth moved by digging and dumping. Only columns whose mass has changed count, so wheel ruts are
/// not included. Active soil that lies on a column counts as part of the column. Soil in the air,
/// in a bucket or in a bed counts as dug, but not yet as spoil.
struct Earthwork {
  /// Volume that was dug, in bank state: mass lost by columns divided by bank density [m3].
  double bank_volume = 0;
  /// Volume of the spoil: rise of the surface, never negative, summed over the columns that gained
  /// mass [m3].
  double loose_volume = 0;
  /// Moved masses of each soil, in the order of the scene's soils.
  std::vector<SoilMoved> soils;
};

/// Returns the earth moved since the start. `on_ground` is the active soil that rests on
/// columns (ActivePlaces::on_ground of sim::active_places). Costs a pass over the changed columns.
Earthwork measure_earthwork(const sim::World& world, const heightfield::LooseSoil& on_ground);
/// Returns the earth moved since the start. Determines the active soil on the columns itself,
/// which costs a pass over all particles.
Earthwork measure_earthwork(const sim::World& world);

}  // namespace navvy::record
