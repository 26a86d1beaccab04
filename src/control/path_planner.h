// SPDX-License-Identifier: Apache-2.0
// The interface through which an operator asks for paths. A module above implements it; the program
// passes it in.
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
  PlanePose start, goal;
  /// Clearance that the footprint keeps from ground the machine cannot drive on, along the whole
  /// path [m].
  double clearance = 0.3;
  /// Iterations after which the search ends; it never ends by time.
  int iterations = 1000;
  /// Seed of the search; not 0.
  std::uint32_t seed = 1;
};

/// Plans paths for one machine on ground that changes.
///
/// Answers depend on the surface that was shown last and on the query alone, bit for bit, whatever
/// was asked before: a run resumed from a snapshot gets the paths of the uninterrupted run. Not
/// thread-safe.
class PathPlanner {
 public:
  virtual ~PathPlanner() = default;
  /// Takes the present ground; all answers refer to it until the next call. Costs what changed
  /// since the last call, and a pass over the active soil.
  virtual void look(const SurfaceView& surface) = 0;
  /// Returns the distance from the machine's footprint at `at` to the nearest ground that it cannot
  /// drive on, unknown ground or the site's edge [m]; `range` when nothing is nearer.
  virtual double clearance(const PlanePose& at, double range) const = 0;
  /// Returns a path, or nothing when the search ends without one.
  virtual std::optional<Path> plan(const PathQuery& query) const = 0;
};

/// Makes the planner of a machine; empty where paths are not planned.
using MakePathPlanner = std::function<std::unique_ptr<PathPlanner>(const scene::Machine&)>;

/// Returns the least clearance of the path from s to its end [m], at most `range`. Samples every
/// 0.1 m, and stops once it is below `enough`.
double clearance_along(const PathPlanner& planner, const Path& path, double s, double range,
                       double enough = 0);

}  // namespace navvy::control
