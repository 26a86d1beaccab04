// SPDX-License-Identifier: Apache-2.0
// Checks a program before a run and reports every target that the machine cannot reach.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "control/arm_kinematics.h"
#include "control/body_view.h"
#include "control/planners.h"
#include "control/surface.h"
#include "core/error.h"
#include "core/math.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "vehicle/machine_state.h"

namespace navvy::control {

/// Checks the reachability of all targets of one program before the run. The check visits the steps
/// in order. Each step reads the machine, the surface and the predicted pose from this object, and
/// reports the targets that it cannot reach.
class ReachCheck {
 public:
  /// Prepares the check of `program` for a machine whose base link starts at the pose
  /// `X_WB_at_start` in W. Messages contain `file` (the scene file) and `name` (the machine's name
  /// in the scene; if empty, the model's name). The machine, the program and the surface must
  /// outlive this object. `planners` makes the planners of paths and of jobs that steps need; a
  /// step whose planner is not available reports that as a fault.
  ReachCheck(const scene::Machine& machine_in, const scene::Program& program,
             const Pose& X_WB_at_start, const SurfaceView& surface_in, std::string file,
             const std::string& name, const Planners& planners);

  /// Machine that runs the program.
  const scene::Machine& machine;
  /// Ground surface to which the targets of digs and drives refer.
  const SurfaceView& surface;
  /// Path planner with an up-to-date map of the surface. Null if no step plans paths or no planner
  /// is available.
  std::unique_ptr<const PathPlanner> planner;
  /// Job planner; null if no step plans jobs or no planner is available.
  std::unique_ptr<const JobPlanner> jobs;
  /// Predicted pose of the base link in W at the beginning of the step being checked.
  Pose X_WB;
  /// Loose bodies of the world where they stand before the program.
  std::vector<BodyView> bodies;

  /// Checks all steps in order, updates X_WB after each step that moves the machine, and returns
  /// the errors and warnings found.
  std::vector<Fault> run();

  /// Adds an error about the step being checked. `element` is the step's element or a part of it,
  /// such as "dig/far end"; `value` is the offending value, `rule` the violated requirement, and
  /// `remedy` a suggestion to the user.
  void fault(const std::string& element, const std::string& value, const std::string& rule,
             const std::string& remedy);
  /// Adds a warning; parameters as for `fault`. Use it for a condition that earlier steps of the
  /// program may still change.
  void warn(const std::string& element, const std::string& value, const std::string& rule,
            const std::string& remedy);
  /// Adds a line about the step being checked that is no fault, such as a row of its plan.
  void note(const std::string& text);
  /// Returns the lines added by `note`.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Returns the number of steps before the one being checked.
  std::size_t steps_before() const { return index_; }
  /// Returns the number of steps after the one being checked.
  std::size_t steps_after() const { return program_.steps.size() - index_ - 1; }
  /// Returns true if a step before the one being checked changes the ground.
  bool after_digging() const;
  /// Adds an error about `element` if the swing angle `swing` [rad] is outside the limits of the
  /// swing joint. `remedy` is a suggestion to the user.
  void require_swing(const ArmKinematics& arm, const char* element, double swing,
                     const char* remedy);

 private:
  /// Adds an error or a warning about the step being checked.
  void add(Fault::Severity severity, const std::string& element, const std::string& value,
           const std::string& rule, const std::string& remedy);

  // The checked program.
  const scene::Program& program_;
  // File and machine name for messages.
  std::string file_, name_;
  // Position of the step being checked in the program, counted from 0.
  std::size_t index_ = 0;
  // Errors and warnings found so far.
  std::vector<Fault> faults_;
  // Lines that are no faults.
  std::vector<std::string> notes_;
};

/// Returns the value with two decimals, followed by a space and the unit.
std::string number_text(double value, const char* unit);
/// Returns a length [m] as text with two decimals, such as "1.50 m".
std::string metres(double value);
/// Returns a position [m] as text with two decimals: "(x , y )".
std::string place_text(const Vec2& p);
/// Returns the explanation for a step that ended because a joint did not reach its target: "joint
/// 'boom_joint' stopped 12.00 deg short of <target>, at its effort limit: something holds it".
/// `rest` is the remaining distance to the target [rad|m].
std::string held_text(const scene::Joint& joint, const vehicle::JointState& state, double rest,
                      const std::string& target);

/// Checks a program and returns an error or warning for every target that is out of reach from the
/// predicted pose of the machine. Each states the required and the possible distance.
///
/// `X_WB` is the pose of the base link in W at the start, and `surface` the ground that the targets
/// of digs and drives refer to. Messages contain `file` (the scene file) and `name` (the machine's
/// name in the scene; if empty, the model's name). `planners` makes the planners of paths and of
/// jobs that steps need. Lines about plans, such as the stations of a job, are appended to `notes`,
/// which may be null. `bodies` are the loose bodies of the world.
std::vector<Fault> check_reach(const scene::Machine& machine, const scene::Program& program,
                               const Pose& X_WB, const SurfaceView& surface,
                               const std::string& file, const std::string& name = "",
                               const Planners& planners = {},
                               std::vector<std::string>* notes = nullptr,
                               std::vector<BodyView> bodies = {});

/// Returns the predicted poses of the base link in W: `X_WB` at the start, followed by the pose
/// after each step of the program that moves the machine.
std::vector<Pose> stations(const scene::Machine& machine, const scene::Program& program,
                           const Pose& X_WB, const SurfaceView& surface);

}  // namespace navvy::control
