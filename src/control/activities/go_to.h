// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Drives to a pose along a planned path, forwards and backwards, around ground that the machine
/// cannot drive on.
///
/// The path is planned when the program begins, so that a missing path is reported before anything
/// moves. It is planned again when the step begins elsewhere, when ground within `clearance` of the
/// remaining path is no longer traversable, when the machine has left it, and when it ends beside
/// the goal. Where no path exists the machine waits for `retry` and tries again, `tries` times in
/// all; then the program ends with the state no_path.
struct GoTo final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "go_to";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText =
      "Drives to a pose along a planned path, around ground that is not traversable.";
  /// Goal of the base link's origin [m] in W.
  Vec2 target = Vec2::Zero();
  /// Heading at the goal [rad].
  double heading = 0;
  /// Largest speed, forwards and backwards [m/s].
  double speed = 1;
  /// Tolerance of the position [m].
  double tolerance = 0.5;
  /// Tolerance of the heading [rad].
  double turn_tolerance = radians(5);
  /// Clearance of the footprint from ground that is not traversable [m].
  double clearance = 0.3;
  /// Time between tries [s].
  double retry = 10;
  int tries = 3;
  /// Iterations of each search.
  int iterations = 1000;
  /// Seed of the first search; each further search takes the next one.
  int seed = 1;

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
  /// Checks that the machine has a drive and the target is on the site.
  void check(const scene::StepSource& source) const;
  const char* element() const override { return kElement; }
  bool needs_planner() const override { return true; }
  std::optional<PathQuery> path_ahead(const PlanePose& from) const override {
    return query(from, 0);
  }
  /// Returns an activity with the phases plan, turn (steers the wheels while standing), drive,
  /// stop, no_path.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Requires the goal to be clear of ground that is not traversable at the start. Where an earlier
  /// step digs or dumps, that is a warning.
  void check_reach(ReachCheck& check) const override;
  /// Returns the pose at the goal, upright on the present ground.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;

  /// Returns the query for plan number `plan`, 0-based.
  PathQuery query(const PlanePose& from, int plan) const;
};

}  // namespace navvy::control
