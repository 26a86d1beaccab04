// SPDX-License-Identifier: Apache-2.0
// Machine in the Bullet engine: tree, joints with hydraulics, wheels, drive, rock.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <optional>
#include <vector>

#include "vehicle/bullet/body.h"
#include "vehicle/bullet/joints.h"
#include "vehicle/bullet/link_shapes.h"
#include "vehicle/bullet/machine_drive.h"
#include "vehicle/bullet/rock.h"
#include "vehicle/bullet/sleeping.h"
#include "vehicle/bullet/wheels.h"

namespace navvy::vehicle {

/// Steps one machine around the solver that all machines share: begin_step, the engine's solver
/// over all rows and contacts, end_step. Counts impulses and work.
///
/// Its parts hold references to each other, so a machine is neither copied nor moved.
class BulletMachine {
 public:
  /// Builds the parts. @throws InputError for data that a part cannot use.
  BulletMachine(const scene::Machine& machine, const Pose& X_WM);
  BulletMachine(const BulletMachine&) = delete;
  BulletMachine& operator=(const BulletMachine&) = delete;

  /// Returns the articulated tree.
  TreeBody& tree() { return tree_; }
  const TreeBody& tree() const { return tree_; }
  /// Returns the data the machine was built from.
  const scene::Machine& scene() const { return machine_; }
  /// Rows and bodies for the engine's solver. Some entries are null.
  std::vector<std::unique_ptr<ServoConstraint>>& servos() { return joints_.servos(); }
  std::vector<std::unique_ptr<BallLimits>>& balls() { return joints_.balls(); }
  std::vector<std::unique_ptr<RockContact>>& rock() { return rock_; }
  const std::vector<std::unique_ptr<DifferentialRow>>& differentials() const {
    return drive_.differentials();
  }
  /// Colliders by link; null for a link without shapes.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& colliders() { return colliders_; }
  /// Returns the shells' plates, by shell. They collide with bodies but not with the ground: shells
  /// meet soil there.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& steel() { return steel_; }
  /// Returns all colliders and plates that exist.
  std::vector<btMultiBodyLinkCollider*> all_colliders() const;
  /// Returns the link that a collider moves with.
  int link_of(const btMultiBodyLinkCollider& collider) const {
    return tree_.link_of_bullet(collider.m_link);
  }
  /// Returns the wheels with their tyres and tracks.
  MachineWheels& wheels() { return wheels_; }

  /// Takes the joint from the drive until the drive's next command.
  void set_joint(int joint, const JointInput& input);
  /// Sets the drive's command. Joints taken by set_joint return to it.
  void set_drive(const DriveInput& input) { drive_.set(input); }
  /// Sets or releases a joint's brake.
  void set_brake(int joint, bool on) { joints_.set_brake(joint, on); }
  /// Returns the command that the drive follows now.
  const DriveInput& drive() const { return drive_.input(); }
  /// Adds a force [N] at p_W for the next step, or applies an impulse [N s, N m s] at once. Both
  /// are counted as external.
  void add_force(int link, const Vec3& f_W, const Vec3& p_W);
  void apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W, double dt);

  /// Returns whether the machine sleeps: it takes no part in the step except as a neighbour. Only
  /// loose bodies of one link sleep.
  bool asleep() const { return rest_ && rest_->asleep(); }
  /// Returns the time at rest [s]; 0 for a machine that never sleeps.
  double still() const { return rest_ ? rest_->still() : 0; }
  /// Wakes the machine because another one that has been at rest for `still` [s] has come near.
  void wake(double still);
  /// Wakes the machine because something pushes it.
  void disturb();
  /// Moves the base of an obstacle to this pose and velocity. It meets sleeping bodies only while
  /// it moves.
  void move_base(const LinkState& link);

  /// Computes servo demands, drive and tyre forces before the solver; `accelerate` then adds
  /// gravity and all forces to the velocities.
  void begin_step(const GroundQuery& ground, double dt);
  void accelerate(const Vec3& gravity, double dt);
  /// Advances positions and reads efforts and work after the solver. `contact` is the impulse of
  /// the rigid contacts with the ground [N s].
  void end_step(const GroundQuery& ground, const Vec3& contact, double dt);

  /// State between two steps, by indices of scene::Machine.
  JointState joint(int joint) const { return joints_.state(joint); }
  WheelState wheel(int wheel) const;
  std::vector<terramechanics::TrackPatch> track_patches(int wheel) const {
    return wheels_.track_patches(wheel);
  }
  /// Returns the impulse of the rock on a shell in the last step [N s].
  const Vec3& rock_impulse(int shell) const {
    return rock_.at(static_cast<std::size_t>(shell))->impulse();
  }
  /// Returns the pump's state; zeros without a pump.
  PumpState pump() const { return {joints_.pump().flow(), joints_.pump().pressure()}; }
  /// Returns the state of the combustion engine; zeros without one.
  const CombustionEngineState& engine() const { return drive_.engine(); }
  /// Returns the work of joints and drive since the start [J].
  double work() const { return joints_.work(); }
  /// Returns the ground's impulse in the last step [N s].
  const Vec3& ground_impulse() const { return ground_impulse_; }
  /// Returns the sum of external impulses since the start [N s].
  const Vec3& external_impulse() const { return external_impulse_; }

  /// Visits all state between two steps. A loaded machine continues exactly as the saved one did.
  void visit(Archive& a);

 private:
  /// Force that add_force stored for the next step.
  struct Push {
    int link = 0;
    Vec3 f_W = Vec3::Zero(), p_W = Vec3::Zero();
    void visit(Archive& a);
  };
  /// Adds collision shapes of links, plates of shells, and a rock contact for every shell.
  void add_colliders();
  void add_steel();
  void add_rock();
  /// Makes the collider of one link's shape, stiff but not rigid.
  std::unique_ptr<btMultiBodyLinkCollider> make_collider(const LinkShape& shape, int link);
  /// Moves all colliders to the present poses.
  void place_colliders();
  /// Computes the bounding box of the base link's shape.
  void box(btVector3& low, btVector3& high) const;
  /// Sets Bullet's activation state of all colliders.
  void set_active(bool active);

  // Each member refers to the members before it.
  scene::Machine machine_;
  TreeBody tree_;
  MachineJoints joints_;
  MachineWheels wheels_;
  MachineDrive drive_;
  std::vector<std::unique_ptr<RockContact>> rock_;  // by shell
  std::vector<LinkShape> shapes_;                   // by link
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<LinkShape> plates_;  // by shell
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> steel_;
  std::vector<Push> pushes_;  // for the next step
  std::optional<Rest> rest_;  // of loose bodies of one link
  // Impulses [N s]. The tyres' part belongs to the present step only.
  Vec3 ground_impulse_ = Vec3::Zero(), tyre_impulse_ = Vec3::Zero(),
       external_impulse_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
