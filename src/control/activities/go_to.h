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

  /// Elements: <target_m>, <heading_deg>, <speed_m_per_s>, <tolerance_m>, <tolerance_deg>,
  /// <clearance_m>, <retry_s>, <tries>, <iterations>, <seed>; the target must lie on the site.
  static GoTo read(const scene::StepSource& source);
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
