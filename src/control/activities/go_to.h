// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/program_step.h"

namespace navvy::control {

/// Go to a pose along a planned path, forwards and backwards, round ground that the machine cannot
/// drive on.
///
/// The path is planned when the program begins, so that a way that is not there is told before
/// anything moves, and anew when the step begins elsewhere, when ground within `clearance` of what
/// is left of the path is no longer traversable, when the machine is off it, and when it ends
/// beside the goal. Where there is none the machine stands for `retry` and tries again, `tries`
/// times in all; then the program ends with the state no_path.
struct GoTo final : ProgramStep {
  /// Name in scene files.
  static constexpr const char* kElement = "go_to";
  static constexpr const char* kText =
      "Drives to a pose along a planned path, around ground that the machine cannot drive on.";
  Vec2 target = Vec2::Zero();          ///< of the base link's origin, [m] in W
  double heading = 0;                  ///< [rad]
  double speed = 1;                    ///< at most, forwards and backwards [m/s]
  double tolerance = 0.5;              ///< of the place [m]
  double turn_tolerance = radians(5);  ///< of the heading [rad]
  double clearance = 0.3;              ///< [m]
  double retry = 10;                   ///< wait between tries [s]
  int tries = 3;
  int iterations = 1000;  ///< of each search
  int seed = 1;           ///< of the first search; each further one takes the next

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
  /// Phases: plan, turn (the wheels, standing), drive, stop, no_path.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// The goal must be clear of ground that is not traversable at the start; where an earlier step
  /// digs or dumps, that is a warning.
  void check_reach(ReachCheck& check) const override;
  /// Upright on the present ground, at the goal.
  std::optional<Pose> station(const scene::Machine& machine, const Pose& X_WB,
                              const SurfaceView& surface) const override;

  /// The question for plan number `plan`, counted from 0.
  PathQuery query(const PlanePose& from, int plan) const;
};

}  // namespace navvy::control
