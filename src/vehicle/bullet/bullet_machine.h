// SPDX-License-Identifier: Apache-2.0
// A machine in the Bullet engine, put together of its parts: tree, joints with hydraulics, wheels,
// drive, rock.
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

/// What happens to one machine within a step, around the solver that all machines share:
/// begin_step, the engine's solver over all rows and contacts, end_step. Counts impulses and work.
///
/// Parts hold references to each other: a machine stays where it was built.
class BulletMachine {
 public:
  /// @throws InputError for what a part cannot build.
  BulletMachine(const scene::Machine& machine, const Pose& X_WM);
  BulletMachine(const BulletMachine&) = delete;
  BulletMachine& operator=(const BulletMachine&) = delete;

  TreeBody& tree() { return tree_; }
  const TreeBody& tree() const { return tree_; }
  const scene::Machine& scene() const { return machine_; }
  /// Rows and bodies that the engine gives to the solver; some entries are null.
  std::vector<std::unique_ptr<ServoConstraint>>& servos() { return joints_.servos(); }
  std::vector<std::unique_ptr<BallLimits>>& balls() { return joints_.balls(); }
  std::vector<std::unique_ptr<RockContact>>& rock() { return rock_; }
  const std::vector<std::unique_ptr<DifferentialRow>>& differentials() const {
    return drive_.differentials();
  }
  /// By link.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& colliders() { return colliders_; }
  /// The shells' plates, which meet bodies and no ground: soil is in their way there. By shell.
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& steel() { return steel_; }
  /// All of both that there are, and the link that one moves with.
  std::vector<btMultiBodyLinkCollider*> all_colliders() const;
  int link_of(const btMultiBodyLinkCollider& collider) const {
    return tree_.link_of_bullet(collider.m_link);
  }
  MachineWheels& wheels() { return wheels_; }

  /// Takes the joint from the drive until the drive's next command.
  void set_joint(int joint, const JointInput& input);
  void set_drive(const DriveInput& input) { drive_.set(input); }
  void set_brake(int joint, bool on) { joints_.set_brake(joint, on); }
  const DriveInput& drive() const { return drive_.input(); }
  /// Force [N] at p_W during the next step; impulse [N s, N m s] at once. Both are counted as
  /// external.
  void add_force(int link, const Vec3& f_W, const Vec3& p_W);
  void apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W, double dt);

  /// It lies still and takes no part in the step but as what others may come near. Loose bodies of
  /// one link alone do.
  bool asleep() const { return rest_ && rest_->asleep(); }
  /// For how long it has been still [s]; 0 of what never sleeps.
  double still() const { return rest_ ? rest_->still() : 0; }
  /// Something has come near that has been still for so long [s].
  void wake(double still);
  /// It is pushed.
  void disturb();
  /// Of one that stands, where what moves it has its base now, and how fast; it meets what lies
  /// still only on its way.
  void move_base(const LinkState& link);

  /// Before the solver: servo demands, drive, tyres on the ground; then gravity and all forces
  /// change the velocities.
  void begin_step(const GroundQuery& ground, double dt);
  void accelerate(const Vec3& gravity, double dt);
  /// After it: positions, efforts, work. `contact`: impulse of the rigid contacts with the ground
  /// [N s].
  void end_step(const GroundQuery& ground, const Vec3& contact, double dt);

  /// As they are between two steps; indices of scene::Machine.
  JointState joint(int joint) const { return joints_.state(joint); }
  WheelState wheel(int wheel) const;
  std::vector<terramechanics::TrackPatch> track_patches(int wheel) const {
    return wheels_.track_patches(wheel);
  }
  /// Of the rock on a shell in the last step [N s].
  const Vec3& rock_impulse(int shell) const {
    return rock_.at(static_cast<std::size_t>(shell))->impulse();
  }
  /// Zeros without a pump.
  PumpState pump() const { return {joints_.pump().flow(), joints_.pump().pressure()}; }
  const CombustionEngineState& engine() const { return drive_.engine(); }
  double work() const { return joints_.work(); }                      ///< [J]
  const Vec3& ground_impulse() const { return ground_impulse_; }      ///< of the last step [N s]
  const Vec3& external_impulse() const { return external_impulse_; }  ///< since the start [N s]

  /// All state between two steps. A loaded machine steps on as the saved one did.
  void visit(Archive& a);

 private:
  /// What add_force left for the next step.
  struct Push {
    int link = 0;
    Vec3 f_W = Vec3::Zero(), p_W = Vec3::Zero();
    void visit(Archive& a);
  };
  /// Collision shapes of the links, plates of the shells, and a contact of every shell with the
  /// rock.
  void add_colliders();
  void add_steel();
  void add_rock();
  std::unique_ptr<btMultiBodyLinkCollider> make_collider(const LinkShape& shape, int link);
  void place_colliders();
  void box(btVector3& low, btVector3& high) const;
  void set_active(bool active);

  // In the order in which each needs the ones before it.
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
  // [N s]; the tyres' part belongs to the present step only.
  Vec3 ground_impulse_ = Vec3::Zero(), tyre_impulse_ = Vec3::Zero(),
       external_impulse_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
