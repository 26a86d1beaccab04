// SPDX-License-Identifier: Apache-2.0
// A machine in the Bullet engine: tree, servos with hydraulics, drive, tyres, counters.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <vector>

#include "vehicle/bullet/body.h"
#include "vehicle/bullet/rock.h"
#include "vehicle/bullet/servo.h"
#include "vehicle/bullet/shapes.h"
#include "vehicle/drive_train.h"
#include "vehicle/joint_servo.h"
#include "vehicle/kinematics.h"
#include "vehicle/pump.h"
#include "vehicle/tyre.h"

namespace navvy::vehicle {

/// What happens to one machine within a step, around the solver that all machines share.
class BulletMachine {
 public:
  BulletMachine(const scene::Machine& machine, const Pose& X_WM);

  TreeBody& tree() { return tree_; }
  const TreeBody& tree() const { return tree_; }
  const scene::Machine& scene() const { return machine_; }
  std::vector<std::unique_ptr<ServoConstraint>>& servos() { return constraints_; }
  std::vector<std::unique_ptr<RockContact>>& rock() { return rock_; }
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& colliders() { return colliders_; }

  void set_joint(int joint, const JointInput& input);
  void set_drive(const DriveInput& input);
  const DriveInput& drive() const { return drive_input_; }
  void add_force(int link, const Vec3& f_W, const Vec3& p_W);
  void apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W);

  /// Before the solver: servo demands, drive, tyres, gravity.
  void begin_step(const Vec3& gravity, const GroundQuery& ground, double dt);
  /// After it: positions, efforts, work. `contact`: impulse of the rigid contacts with the ground [N s].
  void end_step(const Vec3& contact, double dt);

  JointState joint(int joint) const;
  WheelState wheel(int wheel) const;
  /// Of the rock on a shell in the last step [N s].
  const Vec3& rock_impulse(int shell) const { return rock_.at(index(shell))->impulse(); }
  PumpState pump() const { return {pump_.flow(), pump_.pressure()}; }
  double work() const { return work_; }
  const Vec3& ground_impulse() const { return ground_impulse_; }
  const Vec3& external_impulse() const { return external_impulse_; }

  void hash(StateHash& hash) const;
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  struct Actuator {
    JointServo servo;
    int cylinder = -1;         // index into cylinders_
    bool driven = false;       // the drive commands it
    CylinderLimits hydraulic;  // at the step's start
    JointLimits limits;
    JointServo::Demand demand;
    double opened = 0;  // velocity that the valve lets through with oil enough
    double effort = 0;  // in the last step
    double speed_before = 0;
  };
  struct Tyre {
    int spin_joint = -1, steer_joint = -1, wheel_link = -1, carrier_link = -1;
    double spin_inertia = 1;
    Vec3 axis_C = Vec3::UnitY();  // spin axis and centre in the carrier
    Vec3 center_C = Vec3::Zero();
    TyreState state;
    TyreForce force;
    double held_spin = 0;  // angle at which the brake holds [rad]
    bool braked = false;
  };
  struct Push {
    int link;
    Vec3 f_W, p_W;
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void add_actuators();
  void add_tyres();
  void add_colliders();
  void add_rock();
  JointLimits limits(Actuator& a, const scene::Joint& about, double q) const;
  /// Oil [m3/s] that a joint's cylinders take at `velocity`.
  double oil_for(const Actuator& a, double velocity, double q) const;
  /// Share of its oil that every function gets.
  double share_oil(double dt);
  void begin_joints(double dt);
  void begin_drive(double dt);
  void steer_wheels();
  void lock_axles();
  void hold_wheel(Tyre& tyre, double torque, double dt);
  void push_tyres(const GroundQuery& ground, double dt);
  Pose wheel_pose(const Tyre& tyre) const;
  template <class Visit>
  void visit_state(Visit visit);

  scene::Machine machine_;
  TreeBody tree_;
  std::vector<Actuator> actuators_;                            // by joint
  std::vector<std::unique_ptr<ServoConstraint>> constraints_;  // by joint, null where it is fixed or a ball
  std::vector<std::unique_ptr<RockContact>> rock_;             // by shell
  std::vector<CylinderMap> cylinders_;
  Pump pump_;
  std::vector<OilDemand> demands_;  // of the present step
  std::vector<LinkShape> shapes_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<Tyre> tyres_;
  std::vector<int> axle_joints_;  // between chassis and wheel carriers: oscillation
  DriveInput drive_input_;
  DriveTrain drive_train_;
  std::vector<Push> pushes_;
  double work_ = 0;
  Vec3 ground_impulse_ = Vec3::Zero(), tyre_impulse_ = Vec3::Zero(), external_impulse_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
