// SPDX-License-Identifier: Apache-2.0
// Footprint of a machine, and its distance from ground that it cannot drive on.
#pragma once

#include "core/math.h"
#include "map/terrain_map.h"
#include "scene/machine.h"

namespace navvy::planner {

/// A rectangle around a reference point, with x forward and y to the left. The reference point lies
/// within the rectangle, so all lengths are at least 0.
struct Footprint {
  /// Distances from the reference point to the front, rear, left and right side [m].
  double front = 0, rear = 0, left = 0, right = 0;
};

/// Returns the footprint of a machine around the origin of its base link. It encloses the wheels,
/// pointing straight ahead, and the collision shapes of the base link, but not the arms and other
/// moving parts. @throws InputError for a machine that has neither wheels nor such shapes.
Footprint footprint_of(const scene::Machine& machine);

/// Returns the distance [m] from the footprint to the nearest column of `map` that is not drivable.
/// It is exact for the square area of the column. Returns 0 if they overlap, and `range` if no such
/// column is nearer than `range` [m].
///
/// The reference point of the footprint is at world position (x, y) [m], and its x axis has the
/// heading `yaw` [rad] from world x. A column is drivable if its traversability is greater than
/// `least`. Unknown columns and everything outside the site are not drivable. Takes some
/// nanoseconds for each column within `range` of the footprint.
/// @throws InputError for values that are not finite, and for a negative length.
double clearance(const map::TerrainMap& map, const Footprint& footprint, double x, double y,
                 double yaw, double range = 1, float least = 0);

}  // namespace navvy::planner
