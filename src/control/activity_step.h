// SPDX-License-Identifier: Apache-2.0
// Program steps as an operator uses them: the values that a scene sets, and the activity that
// carries out the step.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/job_planner.h"
#include "control/path_planner.h"
#include "control/surface.h"
#include "core/math.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "scene/step_kind.h"

namespace navvy::control {

// The following types are needed only by code that implements steps.
class Activity;
class ReachCheck;
struct OperatorContext;

/// Target at which a step empties the bucket.
struct DumpPoint {
  /// Horizontal position (x, y) in W [m].
  Vec2 at = Vec2::Zero();
  /// Height of the bucket's tip above the ground at `at` [m].
  double height = 0;
};

/// One step of a program: the values that the scene sets, and everything that can be said about the
/// step before it runs.
///
/// Each type of step is a class in `activities/` that derives from this one and defines `kElement`,
/// `kText`, `describe` and `check` (see scene::step_kind). The table that `step_kinds()` returns
/// has one row for it. No other code depends on the class.
class ActivityStep : public scene::Step {
 public:
  /// Returns true if the step needs a machine with an arm (swing, boom, stick and bucket joints).
  /// If any step of a program returns true, the operator holds the arm in position during all
  /// steps.
  virtual bool needs_arm() const { return false; }
  /// Checks that the machine can carry out the step. Unlike `check`, this also runs for programs
  /// built in C++, which no scene reader has checked. @throws InputError if the machine lacks a
  /// part that the step needs.
  virtual void check_machine(const scene::Machine&) const {}
  /// Returns true if the step plans paths. The operator then provides a path planner.
  virtual bool needs_planner() const { return false; }
  /// Returns true if the step plans a job. The operator then provides a job planner.
  virtual bool needs_job_planner() const { return false; }
  /// Returns the number of steps before this one that run again when the step's activity goes back
  /// (Activity::go_back); 0 for a step that never does.
  virtual int repeats() const { return 0; }
  /// Returns true if the program goes on at this step when one before it falls short.
  virtual bool catches() const { return false; }
  /// Returns the path to plan before the program begins. `from` is the pose that the machine will
  /// have when the step starts. Empty if the step needs no path.
  virtual std::optional<PathQuery> path_ahead(const PlanePose& /*from*/) const {
    return std::nullopt;
  }
  /// Returns a new activity that carries out the step. The step and `place` must outlive the
  /// activity.
  virtual std::unique_ptr<Activity> activity(OperatorContext& place) const = 0;

  /// Reports every target of the step that the machine cannot reach from the pose in
  /// `ReachCheck::X_WB`. The default reports nothing.
  virtual void check_reach(ReachCheck&) const {}
  /// Predicts the pose of the base link in W after the step. `X_WB` is the pose before the step.
  /// Empty if the step does not move the base.
  virtual std::optional<Pose> station(const scene::Machine&, const Pose& /*X_WB*/,
                                      const SurfaceView&) const {
    return std::nullopt;
  }
  /// Returns the point at which the step empties the bucket. Empty if the step does not dump at a
  /// given point. The XML element of a step with a dump point has a child <dump_height_m>.
  virtual std::optional<DumpPoint> dump_point() const { return std::nullopt; }
  /// Returns the pit that the step digs, with the place of its spoil; nothing if the step digs
  /// none. A step begun in the middle digs the rest.
  virtual std::optional<PitJob> pit_job() const { return std::nullopt; }
  /// Returns the names of the machines in whose beds the soil must land.
  virtual std::vector<std::string> receivers() const { return {}; }
};

/// Returns the ActivityStep stored in a step of a program. @throws InputError if the stored step
/// does not derive from ActivityStep.
const ActivityStep& step_of(const scene::ProgramStep& step);

}  // namespace navvy::control
