// SPDX-License-Identifier: Apache-2.0
// A program step as the operator knows it: the values a scene may set, and the activity that
// carries it out.
#pragma once

#include <memory>
#include <optional>

#include "control/path_planner.h"
#include "control/surface.h"
#include "core/math.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "scene/step_kind.h"

namespace navvy::control {

// Needed only by code that implements steps.
class Activity;
class ReachCheck;
struct OperatorContext;

/// Position at which a step opens the bucket.
struct DumpPoint {
  /// Position [m] in W.
  Vec2 at = Vec2::Zero();
  /// Height of the tip over the ground there [m].
  double height = 0;
};

/// Description of one step: its values, and everything known about it before it runs.
///
/// A kind of step is a class derived from this one in `activities/`, with `kElement`,
/// `kText`, `describe` and `check` (scene::step_kind), and one row of `step_kinds()`. No other code
/// knows it.
class ActivityStep : public scene::Step {
 public:
  /// Returns true when the machine must have an arm (swing, boom, stick, bucket). The operator of a
  /// program with such a step holds the arm during all its steps.
  virtual bool needs_arm() const { return false; }
  /// Checks the machine; programs built in C++ have passed no reader. @throws InputError when the
  /// machine lacks what the step needs.
  virtual void check_machine(const scene::Machine&) const {}
  /// Returns true when the step asks for paths; the operator then provides a planner.
  virtual bool needs_planner() const { return false; }
  /// Returns the path to plan before the program begins, for a machine that will stand at `from`
  /// when the step starts.
  virtual std::optional<PathQuery> path_ahead(const PlanePose& /*from*/) const {
    return std::nullopt;
  }
  /// Returns a new activity that carries the step out. Step and context must outlive it.
  virtual std::unique_ptr<Activity> activity(OperatorContext& place) const = 0;

  /// Reports every target of the step that cannot be reached from where the machine will then
  /// stand.
  virtual void check_reach(ReachCheck&) const {}
  /// Predicts the pose of the base link after a step that moves the machine, from its pose before.
  virtual std::optional<Pose> station(const scene::Machine&, const Pose& /*X_WB*/,
                                      const SurfaceView&) const {
    return std::nullopt;
  }
  /// Returns where the step empties the bucket, if the scene states it. Its element then has a
  /// child <dump_height_m>.
  virtual std::optional<DumpPoint> dump_point() const { return std::nullopt; }
};

/// Returns the operator's view of a step. @throws InputError for a description that this module did
/// not make.
const ActivityStep& step_of(const scene::ProgramStep& step);

}  // namespace navvy::control
