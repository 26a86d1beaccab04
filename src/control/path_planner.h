// SPDX-License-Identifier: Apache-2.0
// Whom an operator asks for a way. Who implements it is above this module; the program hands it in.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "control/path.h"
#include "control/surface.h"
#include "scene/machine.h"

namespace navvy::control {

/// What a path shall do.
struct PathQuery {
  PlanePose start, goal;
  /// That the footprint keeps from ground the machine cannot drive on, all the way [m].
  double clearance = 0.3;
  int iterations = 1000;   ///< of the search: what ends it, never the time
  std::uint32_t seed = 1;  ///< of the search; not 0
};

/// Plans paths for one machine on ground that changes.
///
/// Answers are a function of the surface that was shown last and the query alone, to the bit,
/// whatever was asked before: a run that goes on from a snapshot gets the paths that the whole run
/// got. One thread at a time.
class PathPlanner {
 public:
  virtual ~PathPlanner() = default;
  /// Takes the ground as it is now; all answers are of it until the next look. Costs what changed
  /// since the last one, and a pass over the awake soil.
  virtual void look(const SurfaceView& surface) = 0;
  /// From the machine's footprint at `at` to the nearest ground that it cannot drive on, unknown
  /// ground or the site's edge [m]; `range` when there is none nearer.
  virtual double clearance(const PlanePose& at, double range) const = 0;
  /// Nothing when the search ends without one.
  virtual std::optional<Path> plan(const PathQuery& query) const = 0;
};

/// Makes the planner of a machine; empty where nobody plans.
using MakePathPlanner = std::function<std::unique_ptr<PathPlanner>(const scene::Machine&)>;

/// Least clearance of the path from s to its end [m], `range` at most; looks every 0.1 m, and no
/// further once it is below `enough`.
double clearance_along(const PathPlanner& planner, const Path& path, double s, double range,
                       double enough = 0);

}  // namespace navvy::control
