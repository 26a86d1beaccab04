// SPDX-License-Identifier: Apache-2.0
// Looks over a program before the run: what cannot be reached is told at once.
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

/// One look over a program, step by step, before anything moves.
///
/// What a step sees when it is asked whether its targets can be reached, and where it tells what
/// cannot.
class ReachCheck {
 public:
  /// `file`, the program's lines and the machine's `name` in the scene are for messages. The
  /// machine stands at `X_WB_at_start`.
  ReachCheck(const scene::Machine& machine_in, const scene::Program& program,
             const Pose& X_WB_at_start, const SurfaceView& surface_in, std::string file,
             const std::string& name, const MakePathPlanner& planners);

  const scene::Machine& machine;  ///< whose program it is
  const SurfaceView& surface;     ///< what digs and drives look at
  /// Has looked at the surface; null where nobody plans, or no step asks for it.
  std::unique_ptr<const PathPlanner> planner;
  Pose X_WB;  ///< base link, when the step begins

  /// Asks every step in turn, moving X_WB on from station to station.
  std::vector<Fault> run();

  /// An error of the present step. `element` is the step's, or a part of it: "dig/far end".
  void fault(const std::string& element, const std::string& value, const std::string& rule,
             const std::string& remedy);
  /// The same as a warning: what may be otherwise by then.
  void warn(const std::string& element, const std::string& value, const std::string& rule,
            const std::string& remedy);
  /// Whether a step before the present one changes the ground.
  bool after_digging() const;
  /// Tells of an angle [rad] beyond the swing joint's limits.
  void require_swing(const ArmKinematics& arm, const char* element, double swing,
                     const char* remedy);

 private:
  void add(Fault::Severity severity, const std::string& element, const std::string& value,
           const std::string& rule, const std::string& remedy);

  // Index of the present step, for messages.
  const scene::Program& program_;
  std::string file_, name_;
  std::size_t index_ = 0;
  std::vector<Fault> faults_;
};

/// Text of messages: a value with two digits and its unit, a place as "(x , y )".
std::string number_text(double value, const char* unit);
/// With the unit m.
std::string metres(double value);
std::string place_text(const Vec2& p);
/// Why a step ends whose joint does not get to its target: "joint 'boom_joint' stopped 12.00 deg
/// short of <target>, at its effort limit: something holds it"; `rest` is what it lacks [rad|m].
std::string held_text(const scene::Joint& joint, const vehicle::JointState& state, double rest,
                      const std::string& target);

/// Every target of the program that cannot be reached from where the machine will then stand:
/// needed and possible distances. `X_WB` is the base link's pose at the start, `surface` the ground
/// that digs and drives look at. Messages call it `name`, as the scene does; empty: by its model.
/// `planners` is asked where a step needs paths.
std::vector<Fault> check_reach(const scene::Machine& machine, const scene::Program& program,
                               const Pose& X_WB, const SurfaceView& surface,
                               const std::string& file, const std::string& name = "",
                               const MakePathPlanner& planners = {});

/// Poses of the base link where a program makes the machine stand: `X_WB` at the start, then the
/// end of every drive.
std::vector<Pose> stations(const scene::Machine& machine, const scene::Program& program,
                           const Pose& X_WB, const SurfaceView& surface);

}  // namespace navvy::control
