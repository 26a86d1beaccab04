// SPDX-License-Identifier: Apache-2.0
// Checks a program before the run and reports every target that cannot be reached.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "control/arm_kinematics.h"
#include "control/path_planner.h"
#include "control/surface.h"
#include "core/error.h"
#include "core/math.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "vehicle/machine_state.h"

namespace navvy::control {

/// One check of a program, step by step, before anything moves. Each step looks at the machine, the
/// surface and the pose at which it will begin, and reports the targets that it cannot reach.
class ReachCheck {
 public:
  /// Prepares the check of `program` for a machine that starts at `X_WB_at_start`. `file` and the
  /// machine's `name` in the scene appear in messages.
  ReachCheck(const scene::Machine& machine_in, const scene::Program& program,
             const Pose& X_WB_at_start, const SurfaceView& surface_in, std::string file,
             const std::string& name, const MakePathPlanner& planners);

  /// The machine that runs the program.
  const scene::Machine& machine;
  /// The surface that digs and drives look at.
  const SurfaceView& surface;
  /// A planner that has looked at the surface; null where no step needs one.
  std::unique_ptr<const PathPlanner> planner;
  /// Pose of the base link when the present step begins.
  Pose X_WB;

  /// Checks every step in turn, moving X_WB from station to station, and returns the faults.
  std::vector<Fault> run();

  /// Adds an error of the present step. `element` is the step's, or a part of it: "dig/far end".
  void fault(const std::string& element, const std::string& value, const std::string& rule,
             const std::string& remedy);
  /// Adds a warning: a condition that may have changed by then.
  void warn(const std::string& element, const std::string& value, const std::string& rule,
            const std::string& remedy);
  /// Returns true when a step before the present one changes the ground.
  bool after_digging() const;
  /// Adds an error when an angle [rad] is beyond the swing joint's limits.
  void require_swing(const ArmKinematics& arm, const char* element, double swing,
                     const char* remedy);

 private:
  void add(Fault::Severity severity, const std::string& element, const std::string& value,
           const std::string& rule, const std::string& remedy);

  // The program; `index_` is the present step, for messages.
  const scene::Program& program_;
  std::string file_, name_;
  std::size_t index_ = 0;
  std::vector<Fault> faults_;
};

/// Formats a value with two digits and its unit.
std::string number_text(double value, const char* unit);
/// Formats a length in metres.
std::string metres(double value);
/// Formats a position as "(x , y )".
std::string place_text(const Vec2& p);
/// Explains why a step ended whose joint does not reach its target: "joint 'boom_joint' stopped
/// 12.00 deg short of <target>, at its effort limit: something holds it". `rest` is the remaining
/// distance [rad|m].
std::string held_text(const scene::Joint& joint, const vehicle::JointState& state, double rest,
                      const std::string& target);

/// Returns a fault for every target of the program that cannot be reached from where the machine
/// will then stand, with needed and possible distances. `X_WB` is the base link's pose at the
/// start, `surface` the ground that digs and drives look at. Messages call the machine `name`;
/// empty: by its model. `planners` makes the planner where a step needs paths.
std::vector<Fault> check_reach(const scene::Machine& machine, const scene::Program& program,
                               const Pose& X_WB, const SurfaceView& surface,
                               const std::string& file, const std::string& name = "",
                               const MakePathPlanner& planners = {});

/// Returns the poses of the base link at which a program makes the machine stand: `X_WB` at the
/// start, then the end of every drive.
std::vector<Pose> stations(const scene::Machine& machine, const scene::Program& program,
                           const Pose& X_WB, const SurfaceView& surface);

}  // namespace navvy::control
