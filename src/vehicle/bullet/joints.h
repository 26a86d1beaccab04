// SPDX-License-Identifier: Apache-2.0
// Joints of a machine in the Bullet engine: servos, limits and their rows in the solver.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/ball_limits.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/hydraulics.h"
#include "vehicle/bullet/servo.h"
#include "vehicle/joint_servo.h"

namespace navvy::vehicle {

/// State of a joint between two steps.
struct Actuator {
  JointServo servo;
  bool spins_wheel = false;  // constant
  // The drive commands it.
  bool driven = false;
  JointLimits limits;  // of this step
  JointServo::Demand demand;
  // Velocity that the valve passes with enough oil.
  double opened = 0;
  double effort = 0;  // in the last step
  double speed_before = 0;
  bool has_brake = false;  // constant
  // Set by command, whatever the servo does.
  bool braked = false;
  // Position at which the brake holds it [rad|m].
  double held = 0;

  /// Visits servo, effort and brake.
  void visit(Archive& a);
};

/// Converts commands into rows of the solver, and its impulses into efforts, work and oil.
///
/// Joints are addressed by their index in scene::Machine. The drive sets row and torque of a
/// wheel's joint that it turns (Actuator::demand); this class only adds its damping.
class MachineJoints {
 public:
  /// Creates the rows. Every joint holds its initial position. Machine and tree must outlive this
  /// object.
  MachineJoints(const scene::Machine& machine, TreeBody& tree);

  /// Returns the state of a joint. @throws std::out_of_range.
  Actuator& operator[](int joint) { return actuators_.at(static_cast<std::size_t>(joint)); }
  const Actuator& operator[](int joint) const {
    return actuators_.at(static_cast<std::size_t>(joint));
  }
  /// Returns the servos by joint; null for fixed and ball joints.
  std::vector<std::unique_ptr<ServoConstraint>>& servos() { return constraints_; }
  /// Returns the limits of ball joints that have any.
  std::vector<std::unique_ptr<BallLimits>>& balls() { return balls_; }
  /// Returns the servo of a joint that moves.
  ServoConstraint& servo(int joint) { return *constraints_[static_cast<std::size_t>(joint)]; }
  /// Returns the machine's pump, idle if it has none.
  const HydraulicPump& pump() const { return hydraulics_.pump(); }
  /// Sets the largest rate of joints that the drive commands by position [rad/s].
  void set_drive_rate(double rate) { drive_rate_ = rate; }

  /// Sets or releases a joint's brake. Has no effect on a joint without one.
  void set_brake(int joint, bool on);

  /// Records the velocities before anything acts, from which work is computed.
  void note_speeds();
  /// Moves valves, shares oil, sets rows and damping. Call it before the solver.
  void begin_step(double dt);
  /// Reads efforts, work and oil, and evaluates the linkages at the new positions. Call it after
  /// the solver.
  void end_step(double dt);

  /// Returns the state after the last step. Limits are those at the present position.
  JointState state(int joint) const;
  double work() const { return work_; }  ///< mechanical, since the start [J]

  /// Visits servos and pump. Visit the tree before: linkages follow its positions.
  void visit(Archive& a);

 private:
  /// Evaluates the linkages at the joints' positions.
  void placed();
  /// Returns the effort and speed available in this step.
  JointLimits limits(int joint) const;
  /// Returns the demand of a set brake for the joint's row in this step.
  JointServo::Demand hold(int joint, double dt);
  /// Returns the share of its oil that every function gets.
  double share_oil(double dt);
  /// Returns whether the drive turns this joint's wheel.
  bool is_drives(const Actuator& a) const { return a.driven && a.spins_wheel; }

  // All vectors are by joint, except the cylinders inside `hydraulics_` and `demands_`, which has
  // one entry per active cylinder.
  const scene::Machine& machine_;
  TreeBody& tree_;
  Hydraulics hydraulics_;
  std::vector<Actuator> actuators_;
  std::vector<std::unique_ptr<ServoConstraint>> constraints_;
  std::vector<std::unique_ptr<BallLimits>> balls_;
  std::vector<OilDemand> demands_;  // of the present step
  double drive_rate_;
  double work_ = 0;
};

}  // namespace navvy::vehicle
