// SPDX-License-Identifier: Apache-2.0
// A program step as the operator knows it: what a scene may say, and what carries it out.
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

// Only those who write steps need these.
class Activity;
class ReachCheck;
struct OperatorContext;

/// Where a step opens the bucket.
struct DumpPoint {
  Vec2 at = Vec2::Zero();  ///< [m] in W
  double height = 0;       ///< of the tip over the ground there [m]
};

/// The description of one step: its values, and everything that is known of it before it runs.
///
/// A kind of step is a class derived from this one in `activities/`, with `kElement` and a static
/// `read` beside it (scene::step_kind), and one row of `step_kinds()`. Nobody else knows it.
class ProgramStep : public scene::Step {
 public:
  // For the operator, before and while the step runs.
  /// Whether its machine must have an arm (swing, boom, stick, bucket). The operator of a program
  /// with such a step holds the arm in all its steps.
  virtual bool needs_arm() const { return false; }
  /// @throws InputError when the machine lacks what the step needs; programs built in C++ have met
  /// no reader.
  virtual void check_machine(const scene::Machine&) const {}
  /// Whether it asks for paths; the operator then brings a planner.
  virtual bool needs_planner() const { return false; }
  /// What to plan before the program begins, for a machine that will stand at `from` when the
  /// step's turn comes.
  virtual std::optional<PathQuery> path_ahead(const PlanePose& /*from*/) const {
    return std::nullopt;
  }
  /// A new activity that carries the step out. Step and workplace must outlive it.
  virtual std::unique_ptr<Activity> activity(OperatorContext& place) const = 0;

  // For checks of a scene that does not run yet.
  /// Reports every target of the step that cannot be reached from where the machine will then
  /// stand.
  virtual void check_reach(ReachCheck&) const {}
  /// Pose of the base link after a step that moves the machine, as far as it can be foretold from
  /// its pose before.
  virtual std::optional<Pose> station(const scene::Machine&, const Pose& /*X_WB*/,
                                      const SurfaceView&) const {
    return std::nullopt;
  }
  /// Where the step empties the bucket, if that is said beforehand. Its element has a child
  /// <dump_height_m> then.
  virtual std::optional<DumpPoint> dump_point() const { return std::nullopt; }
};

/// The operator's view of a step. @throws InputError for a description that did not come from this
/// module.
const ProgramStep& step_of(const scene::ProgramStep& step);

}  // namespace navvy::control
