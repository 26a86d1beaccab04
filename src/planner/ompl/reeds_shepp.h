// SPDX-License-Identifier: Apache-2.0
// Searches for Reeds-Shepp paths by rapidly exploring random trees. The only user of OMPL; only in
// builds with NAVVY_WITH_OMPL.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "control/path.h"

namespace navvy::planner {

/// A search for a path from one pose to another, within a rectangle and through valid poses only.
struct ReedsSheppProblem {
  /// First and last pose of the path, in the world frame.
  control::PlanePose start, goal;
  /// Radius of the arcs of the path [m].
  double radius = 5;
  /// Corners of the rectangle that the positions of all poses must lie in, as world (x, y) [m].
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();
  /// Number of iterations, summed over all trees, after which the search ends.
  int iterations = 1000;
  /// Seed of the random numbers; must not be 0.
  std::uint32_t seed = 1;
  /// Function that returns true if the machine may take a pose.
  std::function<bool(const control::PlanePose&)> valid;
};

/// Length that is added to the cost of a path for each change of direction [m], because the machine
/// then stops and turns its wheels.
inline constexpr double kCuspPrice = 3;

/// Returns the shortest Reeds-Shepp path [Reeds 1990] from start to goal if all its poses are
/// valid. Otherwise searches with pairs of trees [Kuffner 2000], shortens the paths they find, and
/// returns the one with the lowest cost: length plus kCuspPrice per change of direction. Returns no
/// value if no path is found within the iterations. Poses are checked every 0.15 m.
///
/// Equal problems give bit-identical paths: the search does not depend on time, and the random
/// number generator of OMPL is seeded for each call. Several threads may call this function; a lock
/// makes them run one after the other.
std::optional<control::Path> plan_reeds_shepp(const ReedsSheppProblem& problem);

}  // namespace navvy::planner
