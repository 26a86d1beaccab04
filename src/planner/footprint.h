// SPDX-License-Identifier: Apache-2.0
// Distance of a standing machine from ground that it must not touch.
#pragma once

#include "core/math.h"
#include "map/terrain_map.h"
#include "scene/machine.h"

namespace navvy::planner {

/// A rectangle around a reference point, x forward and y left. All lengths are at least 0.
struct Footprint {
  /// Distances from the reference point to the four sides [m].
  double front = 0, rear = 0, left = 0, right = 0;
};

/// Returns the footprint of a machine around the origin of its base link: the rectangle around its
/// wheels, straight ahead, and the collision shapes of its base. Parts that swing above them are
/// left out. @throws InputError for a machine without either.
Footprint footprint_of(const scene::Machine& machine);

/// Returns the distance [m] from the footprint to the nearest column that is not drivable, exact to
/// the square of the column: 0 when they overlap, `range` when no such column is nearer. The
/// reference point is at W (x, y), and x of the footprint is turned by `yaw` [rad] from that of W.
///
/// A column is drivable when its traversability is above `least`. Unknown columns and everything
/// outside the site are not. Costs some nanoseconds per column of the footprint with `range` around
/// it.
/// @throws InputError for a footprint, range or place that is not finite, or for a negative length.
double clearance(const map::TerrainMap& map, const Footprint& footprint, double x, double y,
                 double yaw, double range = 1, float least = 0);

}  // namespace navvy::planner
