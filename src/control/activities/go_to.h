// SPDX-License-Identifier: Apache-2.0
// The program step `go_to`: drives to a target pose along a planned path.
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Drives to a target pose along a planned path, forwards and backwards, around ground that the
/// machine cannot drive on.
///
/// The first path is planned when the program begins, so that a missing path is reported before the
/// machine moves. A new path is planned if
/// - the step begins at a different pose than predicted,
/// - the remaining path no longer keeps `clearance` (keeps_clearance),
/// - the machine has left the path, or
/// - the path ended too far from the target.
///
/// A crawler turns on the spot to the goal's heading, and instead of a path with cusps it turns,
/// drives straight and turns again where there is space (plan_path).
///
/// If the planner finds no path, the machine waits for `retry` and tries again. After `tries`
/// failed attempts in a row the step fails with the state kNoPath.
struct GoTo final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "go_to";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Drives to a pose along a planned path, around ground that is not traversable.";
  /// Target position (x, y) of the base link's origin in W [m].
  Vec2 target = Vec2::Zero();
  /// Heading at the target [rad], counter-clockwise from the x axis of W.
  double heading = 0;
  /// Maximum speed, forwards and backwards [m/s].
  double speed = 1;
  /// Maximum distance from the target at which the machine counts as arrived [m].
  double tolerance = 0.5;
  /// Maximum deviation from the target heading at which the machine counts as arrived [rad].
  double turn_tolerance = radians(5);
  /// Minimum distance of the machine's footprint from ground that is not traversable [m], except
  /// near a start that is nearer to it (keeps_clearance).
  double clearance = 0.3;
  /// Waiting time after a failed attempt to plan a path [s].
  double retry = 10;
  /// Number of failed attempts in a row after which the step fails.
  int tries = 3;
  /// Maximum number of iterations of each path search.
  int iterations = 1000;
  /// Random seed of the first path search. Each further search increases it by 1.
  int seed = 1;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("target_m", target, {-1e6, 1e6}, "Target in W, on the site.", scene::kNeeded);
    f("heading_deg", heading, {-360, 360}, "Heading at the target, from W's x.", scene::kNeeded);
    f("speed_m_per_s", speed, {0.05, 20}, "Top speed, forwards and backwards.");
    f("tolerance_m", tolerance, {0.05, 5}, "Tolerance of the place.");
    f("tolerance_deg", turn_tolerance, {0.5, 180}, "Tolerance of the heading.");
    f("clearance_m", clearance, {0, 10},
      "Clearance from ground that is not traversable or unknown, and from the site's edge.");
    f("retry_s", retry, {0, 1e5}, "Time between tries if there is no path.");
    f("tries", tries, {1, 1000}, "Number of tries.");
    f("iterations", iterations, {1, 1e6}, "Iterations of each search.");
    f("seed", seed, {1, 1e9}, "Seed of the first search; each further search uses the next.");
  }
  /// Reports an error if the machine has no drive, or the target is not on the site.
  void check(const scene::StepSource& source) const;
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the target.
  std::vector<Vec2> places() const override { return {target}; }
  /// Returns true: the step plans paths.
  bool needs_planner() const override { return true; }
  /// Returns the query of the path that is planned when the program begins.
  std::optional<PathQuery> path_ahead(const PlanePose& from) const override {
    return query(from, 0);
  }
  /// Returns an activity with the phases "plan", "turn" (the wheels are steered while the machine
  /// stands), "drive", "stop" and "no_path" (the machine waits for the next attempt).
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports an error if there is no planner, or if the target is too close to ground that is not
  /// traversable before the run. The latter is only a warning if an earlier step digs or dumps and
  /// may change that ground.
  void check_reach(ReachCheck& check) const override;
  /// Returns the predicted pose of the base link in W: upright at the target, at its current height
  /// above the ground.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;

  /// Returns the query for a path from `from` to the target. `plan` is the number of searches made
  /// before; it changes the random seed.
  PathQuery query(const PlanePose& from, int plan) const;
};

}  // namespace navvy::control
