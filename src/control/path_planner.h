// SPDX-License-Identifier: Apache-2.0
// Interface through which an operator requests paths. A higher-level module implements it, and the
// application passes it in.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "control/path.h"
#include "control/surface.h"
#include "scene/machine.h"

namespace navvy::control {

/// A request for a path.
struct PathQuery {
  /// Poses of the machine at the start and at the end of the path.
  PlanePose start, goal;
  /// Minimum distance [m] between the machine's footprint and ground that the machine cannot drive
  /// on, along the whole path except near a start that is nearer to such ground (keeps_clearance).
  double clearance = 0.3;
  /// Maximum number of search iterations. The search has no time limit, so that results repeat.
  int iterations = 1000;
  /// Random seed of the search; must not be 0.
  std::uint32_t seed = 1;
};

/// Plans paths for one machine on changing ground.
///
/// A result depends only on the query and on the surface last passed to `look`, and is
/// bit-identical whatever was requested before. A run resumed from a snapshot therefore gets the
/// same paths as the uninterrupted run. Not thread-safe.
class PathPlanner {
 public:
  virtual ~PathPlanner() = default;
  /// Updates the planner's map from `surface`. All results refer to this map until the next call.
  /// The cost is proportional to the area changed since the last call, plus one pass over the
  /// active soil.
  virtual void look(const SurfaceView& surface) = 0;
  /// Returns the distance [m] from the footprint of a machine at the pose `at` to the nearest
  /// obstacle: ground it cannot drive on, unknown ground, or the site's edge. Returns `range` [m]
  /// if there is no obstacle within that distance.
  virtual double clearance(const PlanePose& at, double range) const = 0;
  /// Returns the length of the machine's footprint [m].
  virtual double length() const = 0;
  /// Returns a path for the query, or nothing if the search found none.
  virtual std::optional<Path> plan(const PathQuery& query) const = 0;
};

/// Function that makes a path planner for a machine. An empty function means that path planning is
/// not available.
using MakePathPlanner = std::function<std::unique_ptr<PathPlanner>(const scene::Machine&)>;

/// Clearance that a machine keeps while it leaves an obstacle that it stands near to [m].
inline constexpr double kLeastClearance = 0.02;

/// Returns the clearance [m] that a path from `start` keeps near that pose (is_near). It is
/// `clearance` [m], but kLeastClearance, or the clearance of `start` where that is less, for a
/// machine that stands nearer to an obstacle than `clearance`: such a machine may drive away. It is
/// `clearance` for one that stands on an obstacle.
double clearance_near(const PathPlanner& planner, const PlanePose& start, double clearance);

/// Returns true if `at` is no farther from `start` than two lengths of the machine: far enough to
/// drive along a wall beside it, from which it cannot turn away, until its rear is past the end.
bool is_near(const PathPlanner& planner, const PlanePose& at, const PlanePose& start);

/// Returns true if `path` keeps `clearance` [m] from the driven distance `s` [m] to its end, and
/// clearance_near near its start. The path is sampled every 0.1 m.
bool keeps_clearance(const PathPlanner& planner, const Path& path, double s, double clearance);

}  // namespace navvy::control
