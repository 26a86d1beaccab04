// SPDX-License-Identifier: Apache-2.0
// The only place with OMPL: Reeds-Shepp paths by rapidly exploring random trees. Exists only in
// builds with NAVVY_WITH_OMPL.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "control/path.h"

namespace navvy::planner {

/// From one pose to another within a rectangle, where `valid` says where the machine may be.
struct ReedsSheppProblem {
  control::PlanePose start, goal;
  double radius = 5;                             ///< of the bends [m]
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();  ///< the reference point stays within [m]
  int iterations = 1000;                         ///< of all trees together; what ends the search
  std::uint32_t seed = 1;                        ///< not 0
  std::function<bool(const control::PlanePose&)> valid;
};

/// Metres of way that a change of direction counts for when paths are compared: a stop, and wheels
/// turned standing.
inline constexpr double kCuspPrice = 3;

/// The shortest Reeds-Shepp path [Reeds 1990] where that is valid. Else the cheapest of several
/// that pairs of trees [Kuffner 2000] find with the iterations, each shortened by straight
/// connections between its places. Poses are asked for every 0.15 m.
///
/// Equal problems give equal paths, to the bit: nothing looks at the time, and the library's one
/// source of seeds is set anew under a lock. May be called from several threads; they take turns.
std::optional<control::Path> plan_reeds_shepp(const ReedsSheppProblem& problem);

}  // namespace navvy::planner
