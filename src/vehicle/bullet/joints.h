// SPDX-License-Identifier: Apache-2.0
// Joints of a machine in the Bullet engine: servos, brakes, limits, and their constraint rows in
// the solver.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/ball_limits.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/hydraulics.h"
#include "vehicle/bullet/servo.h"
#include "vehicle/joint_servo.h"

namespace navvy::vehicle {

/// State of one joint between two steps, and its demand in the current step.
struct Actuator {
  /// Servo with the joint's command.
  JointServo servo;
  /// True for a joint on which a wheel spins. Constant.
  bool spins_wheel = false;
  /// True while the drive commands the joint.
  bool driven = false;
  /// Limits of the joint in the current step.
  JointLimits limits;
  /// Motion that the solver should give the joint in the current step.
  JointServo::Demand demand;
  /// Velocity that the valve passes with enough oil [rad/s|m/s].
  double opened = 0;
  /// Effort on the joint in the last step [N m|N].
  double effort = 0;
  /// Velocity of the joint at the start of the step [rad/s|m/s].
  double speed_before = 0;
  /// True for a joint with a brake. Constant.
  bool has_brake = false;
  /// True while the brake is set.
  bool braked = false;
  /// Position at which the brake holds the joint [rad|m].
  double held = 0;

  /// Saves, loads or hashes servo, effort and brake.
  void visit(Archive& a);
};

/// Converts joint commands to constraint rows of the solver, and the solver's impulses to efforts,
/// work and oil flow.
///
/// Joints have the indices of scene::Machine. For the joint of a wheel that the drive turns, the
/// drive itself sets row and torque (Actuator::demand); this class only adds the joint's damping.
class MachineJoints {
 public:
  /// Allocates the constraint rows. Every joint holds its initial position. `machine` and `tree`
  /// must exist as long as this object.
  MachineJoints(const scene::Machine& machine, TreeBody& tree);

  /// Returns the state of a joint.
  /// @throws std::out_of_range for an index without a joint.
  Actuator& operator[](int joint) { return actuators_.at(static_cast<std::size_t>(joint)); }
  /// Returns the state of a joint.
  /// @throws std::out_of_range for an index without a joint.
  const Actuator& operator[](int joint) const {
    return actuators_.at(static_cast<std::size_t>(joint));
  }
  /// Returns the constraint rows of the servos, indexed by joint; null for fixed and ball joints.
  std::vector<std::unique_ptr<ServoConstraint>>& servos() { return constraints_; }
  /// Returns the constraint rows of those ball joints that have limits.
  std::vector<std::unique_ptr<BallLimits>>& balls() { return balls_; }
  /// Returns the constraint rows of a revolute or prismatic joint.
  ServoConstraint& servo(int joint) { return *constraints_[static_cast<std::size_t>(joint)]; }
  /// Returns the machine's pump, which stays idle in a machine without one.
  const HydraulicPump& pump() const { return hydraulics_.pump(); }
  /// Sets the largest speed [rad/s] of joints that the drive commands by position, which are the
  /// steering joints.
  void set_drive_rate(double rate) { drive_rate_ = rate; }

  /// Sets or releases the brake of a joint. Does nothing for a joint without a brake.
  void set_brake(int joint, bool on);

  /// Records all joint velocities, from which end_step() computes the work. Call it at the start of
  /// a step, before any force acts.
  void note_speeds();
  /// Moves the valves, distributes the oil, and sets constraint rows and damping for a step of `dt`
  /// [s]. Call it before the solver.
  void begin_step(double dt);
  /// Computes efforts, work and oil flow from the solver's impulses of a step of `dt` [s], and
  /// evaluates the cylinders at the new positions. Call it after the solver.
  void end_step(double dt);

  /// Returns the state of a joint after the last step, with the limits at its current position.
  JointState state(int joint) const;
  /// Returns the mechanical work that all joints have done since the start [J]. Work that a load
  /// does on a joint is not subtracted.
  double work() const { return work_; }

  /// Saves, loads or hashes servos, brakes and pump. Call it after TreeBody::visit(), since loading
  /// evaluates the cylinders at the tree's positions.
  void visit(Archive& a);

 private:
  /// Evaluates all cylinders at the current joint positions.
  void placed();
  /// Returns the limits of a joint's effort and speed in this step.
  JointLimits limits(int joint) const;
  /// Returns the demand with which a set brake holds the joint in a step of `dt` [s].
  JointServo::Demand hold(int joint, double dt);
  /// Returns the share (0 to 1) of its demanded oil that every cylinder gets in this step.
  double share_oil(double dt);
  /// Returns true if the drive turns the wheel on this joint.
  bool is_drives(const Actuator& a) const { return a.driven && a.spins_wheel; }

  /// Scene data of the machine.
  const scene::Machine& machine_;
  /// Articulated tree of the machine.
  TreeBody& tree_;
  /// Cylinders and pump of the machine.
  Hydraulics hydraulics_;
  /// State of each joint.
  std::vector<Actuator> actuators_;
  /// Constraint rows of the servos, indexed by joint; null for fixed and ball joints.
  std::vector<std::unique_ptr<ServoConstraint>> constraints_;
  /// Constraint rows of those ball joints that have limits.
  std::vector<std::unique_ptr<BallLimits>> balls_;
  /// Oil demands in the current step, one per cylinder whose joint can move.
  std::vector<OilDemand> demands_;
  /// Largest speed of joints that the drive commands by position [rad/s].
  double drive_rate_;
  /// Work of all joints since the start [J].
  double work_ = 0;
};

}  // namespace navvy::vehicle
