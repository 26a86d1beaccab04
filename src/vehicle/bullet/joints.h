// SPDX-License-Identifier: Apache-2.0
// The joints of a machine in the Bullet engine: their servos, what limits them, and their rows in
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

/// A joint between two steps.
struct Actuator {
  JointServo servo;
  bool spins_wheel = false;  // never changes
  bool driven = false;       // the drive commands it
  JointLimits limits;        // of this step
  JointServo::Demand demand;
  double opened = 0;  // velocity that the valve lets through with oil enough
  double effort = 0;  // in the last step
  double speed_before = 0;
  bool has_brake = false;  // never changes
  bool braked = false;     // by command, whatever the servo is told
  double held = 0;         // where the brake holds it [rad|m]

  void visit(Archive& a);
};

/// Turns commands into rows of the solver and its answer into efforts, work and oil.
///
/// Joints by their index in scene::Machine. A wheel's joint that the drive turns gets its row and
/// torque from there (Actuator::demand); here it only gets its damping.
class MachineJoints {
 public:
  /// Every joint holds its initial position. Machine and tree must outlive it.
  MachineJoints(const scene::Machine& machine, TreeBody& tree);

  Actuator& operator[](int joint) { return actuators_.at(static_cast<std::size_t>(joint)); }
  const Actuator& operator[](int joint) const {
    return actuators_.at(static_cast<std::size_t>(joint));
  }
  /// By joint, null where it is fixed or a ball.
  std::vector<std::unique_ptr<ServoConstraint>>& servos() { return constraints_; }
  /// Of those balls that have any.
  std::vector<std::unique_ptr<BallLimits>>& balls() { return balls_; }
  /// Of a joint that moves.
  ServoConstraint& servo(int joint) { return *constraints_[static_cast<std::size_t>(joint)]; }
  /// The machine's, idle where it has none.
  const HydraulicPump& pump() const { return hydraulics_.pump(); }
  /// Fastest turning of joints that the drive commands by position [rad/s].
  void set_drive_rate(double rate) { drive_rate_ = rate; }

  /// Nothing to a joint without a brake.
  void set_brake(int joint, bool on);

  /// Velocities before anything acts: work is counted from them.
  void note_speeds();
  /// Before the solver: valves, oil, rows and damping.
  void begin_step(double dt);
  /// After it, positions moved: efforts, work, oil taken, and the linkages at their new place.
  void end_step(double dt);

  /// As told by the last step; limits are those at the present place.
  JointState state(int joint) const;
  double work() const { return work_; }  ///< mechanical, done since the start [J]

  /// Visit the tree before: linkages follow its positions.
  void visit(Archive& a);

 private:
  /// Puts the linkages to where the joints are.
  void placed();
  /// What effort and speed are to be had in this step.
  JointLimits limits(int joint) const;
  /// What the brake of a joint asks of its row in this step.
  JointServo::Demand hold(int joint, double dt);
  /// Share of its oil that every function gets.
  double share_oil(double dt);
  bool is_drives(const Actuator& a) const { return a.driven && a.spins_wheel; }

  // By joint, but for the cylinders inside `hydraulics_` and `demands_`, one for each that acts.
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
