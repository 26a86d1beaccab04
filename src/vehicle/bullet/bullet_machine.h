// SPDX-License-Identifier: Apache-2.0
// One machine in the Bullet engine: tree, joints with hydraulics, wheels, drive, and contacts with
// rock.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <optional>
#include <vector>

#include "vehicle/bullet/body.h"
#include "vehicle/bullet/joints.h"
#include "vehicle/bullet/link_shapes.h"
#include "vehicle/bullet/machine_drive.h"
#include "vehicle/bullet/mechanism_rows.h"
#include "vehicle/bullet/rock.h"
#include "vehicle/bullet/sleeping.h"
#include "vehicle/bullet/wheels.h"

namespace navvy::vehicle {

/// One machine of the Bullet engine.
///
/// A step has three parts: begin_step() and accelerate(), then the engine's solver over the rows
/// and contacts of all machines, then end_step(). The machine also sums up its impulses and work.
///
/// The parts of a machine refer to each other, so a machine is neither copied nor moved.
class BulletMachine {
 public:
  /// Builds all parts of `machine`, with its model frame M at the pose `X_WM`.
  /// @throws InputError for data that a part cannot use.
  BulletMachine(const scene::Machine& machine, const Pose& X_WM);
  BulletMachine(const BulletMachine&) = delete;
  BulletMachine& operator=(const BulletMachine&) = delete;

  /// Returns the articulated tree of the machine.
  TreeBody& tree() { return tree_; }
  /// Returns the articulated tree of the machine.
  const TreeBody& tree() const { return tree_; }
  /// Returns the scene data from which the machine was built.
  const scene::Machine& scene() const { return machine_; }
  /// Returns the constraint rows of the joints' servos, indexed by joint; null for a joint without
  /// a servo.
  std::vector<std::unique_ptr<ServoConstraint>>& servos() { return joints_.servos(); }
  /// Returns the constraint rows of those ball joints that have limits.
  std::vector<std::unique_ptr<BallLimits>>& balls() { return joints_.balls(); }
  /// Returns the constraint rows between shells and rock, one entry per shell.
  std::vector<std::unique_ptr<RockContact>>& rock() { return rock_; }
  /// Returns the constraint rows of the differentials that couple their shafts.
  const std::vector<std::unique_ptr<DifferentialRow>>& differentials() const {
    return drive_.differentials();
  }
  /// Returns the constraint rows of gears and closed loops; null for a machine without them.
  MechanismRows* mechanism() { return mechanism_.get(); }
  /// Returns the constraint rows of the joints' springs.
  const std::vector<std::unique_ptr<SpringRow>>& springs() const { return springs_; }
  /// Returns the collision objects of the links, indexed by link; null for a link without collision
  /// shapes.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& colliders() { return colliders_; }
  /// Returns the collision objects of the shells (steel plates of tools), indexed by shell. They
  /// collide with bodies but not with the ground, since the soil model computes the force of soil
  /// on shells.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& steel() { return steel_; }
  /// Returns all collision objects of links and shells; no entry is null.
  std::vector<btMultiBodyLinkCollider*> all_colliders() const;
  /// Returns the index of the link with which a collision object moves.
  int link_of(const btMultiBodyLinkCollider& collider) const {
    return tree_.link_of_bullet(collider.m_link);
  }
  /// Returns the wheels with their tyres and tracks.
  MachineWheels& wheels() { return wheels_; }

  /// Sets the command of a joint. If the drive controls the joint, this command overrides the drive
  /// until the drive's next command.
  void set_joint(int joint, const JointInput& input);
  /// Sets the drive's command. Joints that set_joint() has overridden follow the drive again.
  void set_drive(const DriveInput& input) { drive_.set(input); }
  /// Sets or releases the brake of a joint.
  void set_brake(int joint, bool on) { joints_.set_brake(joint, on); }
  /// Returns the command that the drive currently follows.
  const DriveInput& drive() const { return drive_.input(); }
  /// Adds a force `f_W` [N] at the point `p_W` [m] on a link for the next step. It counts as an
  /// external impulse.
  void add_force(int link, const Vec3& f_W, const Vec3& p_W);
  /// Applies an impulse `J_W` [N s] at the point `p_W` [m] and an angular impulse `L_W` [N m s] to
  /// a link at once; see TreeBody::apply_impulse() for `dt` [s]. It counts as an external impulse.
  void apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W, double dt);

  /// Returns true if the machine sleeps: it is at rest and takes no part in the step, but other
  /// bodies still collide with it. Only loose bodies of one link can sleep.
  bool asleep() const { return rest_ && rest_->asleep(); }
  /// Returns the time for which the machine has been at rest [s]; 0 for a machine that never
  /// sleeps.
  double still() const { return rest_ ? rest_->still() : 0; }
  /// Wakes the machine because another one, which has been at rest for `still` [s], has come near.
  void wake(double still);
  /// Wakes the machine because a force or impulse acts on it.
  void disturb();
  /// Moves the base link of an obstacle to the given pose and velocity. The obstacle collides with
  /// sleeping bodies only while it moves.
  void move_base(const LinkState& link);

  /// Computes the demands of the servos, the drive, and the forces on tyres and tracks from
  /// `ground`, for a step of `dt` [s]. Call it before accelerate().
  void begin_step(const GroundQuery& ground, double dt);
  /// Adds the effect of gravity (in the world frame [m/s2]) and of all forces to the velocities.
  /// Call it before the solver.
  void accelerate(const Vec3& gravity, double dt);
  /// Advances positions and reads efforts and work after the solver. `contact` is the impulse of
  /// all rigid contacts of this machine with the ground in the world frame [N s].
  void end_step(const GroundQuery& ground, const Vec3& contact, double dt);

  /// Returns the state of a joint after the last step.
  JointState joint(int joint) const { return joints_.state(joint); }
  /// Returns the state of a wheel or track after the last step.
  WheelState wheel(int wheel) const;
  /// Returns the rectangles on which the track of a wheel pressed in the last step; empty for a
  /// wheel without a track.
  std::vector<terramechanics::TrackPatch> track_patches(int wheel) const {
    return wheels_.track_patches(wheel);
  }
  /// Returns the impulse of the rock on a shell in the last step, in the world frame [N s].
  const Vec3& rock_impulse(int shell) const {
    return rock_.at(static_cast<std::size_t>(shell))->impulse();
  }
  /// Returns the state of the machine's pump; all zero without a pump.
  PumpState pump() const { return {joints_.pump().flow(), joints_.pump().pressure()}; }
  /// Returns the state of the combustion engine; all zero without one.
  const CombustionEngineState& engine() const { return drive_.engine(); }
  /// Returns the mechanical work that joints and drive have done since the start [J].
  double work() const { return joints_.work(); }
  /// Returns the impulse of the ground on the machine in the last step, in the world frame [N s].
  const Vec3& ground_impulse() const { return ground_impulse_; }
  /// Returns the sum of all external impulses since the start, in the world frame [N s].
  const Vec3& external_impulse() const { return external_impulse_; }

  /// Saves, loads or hashes all state between two steps. A loaded machine continues exactly as the
  /// saved one.
  void visit(Archive& a);

 private:
  /// Force on a link that add_force() has stored for the next step.
  struct Push {
    /// Index of the link on which the force acts.
    int link = 0;
    /// Force [N] and point of application [m] in the world frame.
    Vec3 f_W = Vec3::Zero(), p_W = Vec3::Zero();
    /// Saves, loads or hashes link, force and point.
    void visit(Archive& a);
  };
  /// Makes the collision objects of all links with collision shapes.
  void add_colliders();
  /// Makes the collision objects of all shells.
  void add_steel();
  /// Makes the constraint rows between each shell and the rock.
  void add_rock();
  /// Returns a new collision object with the shape `shape` of the link with index `link`. Its
  /// contacts are stiff but not rigid.
  std::unique_ptr<btMultiBodyLinkCollider> make_collider(const LinkShape& shape, int link);
  /// Moves all collision objects to the current poses.
  void place_colliders();
  /// Computes the bounding box of the base link's collision shapes in the world frame [m].
  void box(btVector3& low, btVector3& high) const;
  /// Sets Bullet's activation state of the base link's collision object.
  void set_active(bool active);

  /// Scene data from which the machine was built. It must be declared first: each of the following
  /// members refers to members before it.
  scene::Machine machine_;
  /// Articulated tree.
  TreeBody tree_;
  /// Joints with servos, brakes and hydraulics.
  MachineJoints joints_;
  /// Wheels with tyres and tracks.
  MachineWheels wheels_;
  /// Drive that turns and steers the wheels.
  MachineDrive drive_;
  /// Constraint rows of gears and closed loops, or null, and those of springs.
  std::unique_ptr<MechanismRows> mechanism_;
  std::vector<std::unique_ptr<SpringRow>> springs_;
  /// Constraint rows between shells and rock, indexed by shell.
  std::vector<std::unique_ptr<RockContact>> rock_;
  /// Collision shapes of the links, indexed by link.
  std::vector<LinkShape> shapes_;
  /// Collision objects of the links, indexed by link; null for a link without shapes.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  /// Collision shapes of the shells, indexed by shell.
  std::vector<LinkShape> plates_;
  /// Collision objects of the shells, indexed by shell.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> steel_;
  /// Forces that act in the next step.
  std::vector<Push> pushes_;
  /// Sleep state; empty for a machine that never sleeps.
  std::optional<Rest> rest_;
  /// Impulse of the ground in the last step, the part of it from tyres and tracks, and the sum of
  /// external impulses since the start, in the world frame [N s].
  Vec3 ground_impulse_ = Vec3::Zero(), tyre_impulse_ = Vec3::Zero(),
       external_impulse_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
