// SPDX-License-Identifier: Apache-2.0
// How near a standing machine is to ground that it must not touch.
#pragma once

#include "core/math.h"
#include "map/terrain_map.h"
#include "scene/machine.h"

namespace navvy::planner {

/// A rectangle round a reference point, x forward and y left. All at least 0 [m].
struct Footprint {
  double front = 0, rear = 0, left = 0, right = 0;
};

/// Of a machine, round its base link's origin: the rectangle about its wheels, straight ahead, and
/// the collision shapes of its base. What swings above them is left out. @throws InputError for a
/// machine without either.
Footprint footprint_of(const scene::Machine& machine);

/// Distance from the footprint, its reference point at W (x, y) and its x turned by `yaw` [rad]
/// from W's, to the nearest column that is not traversable [m]: to the column's square, exactly. 0
/// when they overlap, `range` when there is none nearer.
///
/// A column is traversable when the map's traversability is above `least`. Unknown columns and
/// everything outside the site are not. Costs some nanoseconds a column of the footprint with
/// `range` round it.
/// @throws InputError for a footprint, range or place that is not finite, or below 0.
double clearance(const map::TerrainMap& map, const Footprint& footprint, double x, double y,
                 double yaw, double range = 1, float least = 0);

}  // namespace navvy::planner
