// SPDX-License-Identifier: Apache-2.0
// Reeds-Shepp paths by rapidly exploring random trees; the only place with OMPL. Exists only in
// builds with NAVVY_WITH_OMPL.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "control/path.h"

namespace navvy::planner {

/// A search from one pose to another within a rectangle, through poses that `valid` accepts.
struct ReedsSheppProblem {
  /// Poses in W.
  control::PlanePose start, goal;
  /// Radius of the bends [m].
  double radius = 5;
  /// Rectangle that the reference point stays in [m].
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();
  /// Iterations of all trees together, which end the search.
  int iterations = 1000;
  /// Seed of the random numbers; not 0.
  std::uint32_t seed = 1;
  /// Returns true for poses that the machine may take.
  std::function<bool(const control::PlanePose&)> valid;
};

/// Length [m] that a change of direction counts for when paths are compared: the machine stops and
/// turns its wheels.
inline constexpr double kCuspPrice = 3;

/// Returns the shortest Reeds-Shepp path [Reeds 1990] where it is valid. Otherwise returns the
/// cheapest of several paths that pairs of trees [Kuffner 2000] find within the iterations, each
/// shortened by straight connections between its places; nothing when none is found. Poses are
/// checked every 0.15 m.
///
/// Equal problems give bit-identical paths: nothing depends on the time, and the only source of
/// seeds in the library is set anew under a lock. Several threads may call it; they take turns.
std::optional<control::Path> plan_reeds_shepp(const ReedsSheppProblem& problem);

}  // namespace navvy::planner
