// SPDX-License-Identifier: Apache-2.0
// Articulated tree of Bullet [Featherstone 2008] for one machine, in the machine's own link frames.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <memory>
#include <vector>

#include "core/archive.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Owns the btMultiBody of a machine.
///
/// Bullet requires link frames at the centres of mass along the principal axes; this class hides
/// that. It computes kinematics and momentum of the tree and applies impulses; it commands nothing.
class TreeBody {
 public:
  /// Builds the tree.
  /// @throws InputError for joints that form no tree, or a moving link without mass or inertia.
  TreeBody(const scene::Machine& machine, const Pose& X_WM);
  TreeBody(const TreeBody&) = delete;
  TreeBody& operator=(const TreeBody&) = delete;

  /// Gives access for constraints, colliders and the solver. Call moved() after changing positions.
  btMultiBody& multibody() { return *body_; }
  /// Returns Bullet's link of a joint; -1: none (a joint of the base to the world).
  int bullet_of_joint(int joint) const { return bullet_of_joint_[index(joint)]; }
  /// Returns Bullet's link of a link; -1 for the base.
  int bullet_of_link(int link) const { return bullet_of_link_[index(link)]; }
  /// Returns the link of a Bullet link; Bullet's base is -1.
  int link_of_bullet(int bullet) const { return bullet < 0 ? 0 : link_of_bullet_[index(bullet)]; }
  /// Returns the pose of Bullet's frame of a link in the link.
  const Pose& inertial_frame(int link) const { return X_LI_[index(link)]; }

  /// Returns position [rad|m] or velocity [rad/s|m/s] of a joint with one degree of freedom; 0 for
  /// others.
  double position(int joint) const;
  double velocity(int joint) const;
  /// Sets the position of a joint to q. Velocities do not change.
  void set_position(int joint, double q);

  /// Returns pose and velocity of a link's own frame, as the model defines it.
  LinkState link(int link) const;
  /// Centre of mass of a link in W [m].
  Vec3 center(int link) const;
  /// Returns the mass of a link [kg].
  double mass(int link) const { return mass_[index(link)]; }
  /// Returns the mass of all moving parts [kg]: without a fixed base.
  double total_mass() const { return total_mass_; }
  /// Returns whether the base is part of the world.
  bool fixed_base() const { return body_->hasFixedBase(); }
  /// Returns the momentum of all moving parts [N s].
  Vec3 momentum() const;
  /// Returns origin [m] or axis of a joint in W.
  Vec3 joint_origin(int joint) const;
  Vec3 joint_axis(int joint) const;
  /// Returns the inertia [kg m2|kg] of everything outward of the joint, about or along its axis.
  double outward_inertia(int joint) const;

  /// Adds a force [N] with moment [N m] about p_W for the next step.
  void add_force(int link, const Vec3& f_W, const Vec3& m_W, const Vec3& p_W);
  /// Applies an impulse. Velocities change at once by the articulated inertia of the present pose,
  /// and a body without joints moves by dt [s] times its change. Returns whether it moved. The next
  /// step expects the same impulse again (support_).
  bool apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W, double dt);
  /// Computes the virtual work of an impulse on each degree of freedom in Bullet's order: base
  /// (angular, linear), then joints. `work` holds 6 + the number of joints. For a unit impulse
  /// without moment it is the Jacobian row of a point's velocity along it.
  void virtual_work(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
                    double* work) const;
  /// Returns the inverse articulated mass at the link's origin, (angular, linear), axes of W.
  Mat6 inverse_mass(int link) const;

  /// Advances the velocities by gravity and added forces in one explicit step. For the solver a
  /// body without joints also carries its expected support, the mean of the last impulses of steps
  /// (apply_impulse); step_positions removes it again.
  void step_velocities(const Vec3& gravity, double dt);
  /// Sets all velocities to zero.
  void stop();
  /// Sets pose and velocity of the base link. The joints do not change.
  void set_base(const LinkState& link);
  /// Applies the solver's velocity changes, then advances the positions.
  void step_positions(double dt);
  /// Invalidates everything computed from positions, after a change from outside.
  void moved() { kinematics_valid_ = factors_valid_ = false; }
  /// Moves the collision objects to the present poses.
  void place_colliders();

  /// Visits base pose, joint positions, velocities and expected support: all state of the tree
  /// between two steps.
  void visit(Archive& a);

 private:
  /// Pose and velocity of a link's inertial frame I.
  struct Frame {
    Pose X_WI = Pose::Identity();
    Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();  // of the centre of mass
  };
  /// Converts an index that is not negative.
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  /// Adds the links outward from the base, in the order of the joints.
  void build(const scene::Machine& machine);
  /// Adds a joint and its child link to Bullet's tree.
  void add_joint(const scene::Machine& machine, int joint, int bullet);
  /// Returns base position and orientation followed by every joint's coordinates; the generalised
  /// velocity, as getVelocityVector has it.
  std::vector<double> coordinates() const;
  std::vector<double> velocities() const;
  /// Sets coordinates and generalised velocity.
  void place(const std::vector<double>& coordinates, const std::vector<double>& velocities);
  /// Computes poses and velocities of all links, and the articulated inertias, once after each
  /// change.
  void update_kinematics() const;
  void update_factors() const;
  /// Computes the change of generalised velocity by an impulse.
  void respond(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
               std::vector<double>& delta) const;
  /// Returns the velocity of a link's origin for a generalised velocity, (angular, linear).
  Vec6 twist_of(int link, const std::vector<double>& velocity) const;

  std::unique_ptr<btMultiBody> body_;
  // Maps between the machine's indices and Bullet's. Bullet's base is -1.
  std::vector<int> bullet_of_joint_, bullet_of_link_, link_of_bullet_, joint_of_bullet_;
  // Inertial frame in the link, mass [kg], and inertia about the centre in the link's axes [kg m2],
  // by link.
  std::vector<Pose> X_LI_;
  std::vector<double> mass_;
  std::vector<Mat3> inertia_;
  std::vector<std::vector<int>> outward_;  // links outward of each Bullet link, itself included
  std::vector<Vec3> pivot_I_;              // joint origin in the child's Bullet frame
  double total_mass_ = 0;
  // Expected support of a body without joints, (angular about its centre, linear): impulse since
  // the last step [N m s, N s], its mean as a force [N m, N], and the velocities that the solver
  // gains from it.
  Vec6 support_ = Vec6::Zero(), bearing_ = Vec6::Zero();
  std::vector<double> expected_;
  // Computed on demand. Bullet needs scratch memory of its own.
  mutable bool kinematics_valid_ = false, factors_valid_ = false;
  mutable std::vector<Frame> frames_;  // by link
  mutable btAlignedObjectArray<btScalar> scratch_r_;
  mutable btAlignedObjectArray<btVector3> scratch_v_;
  mutable btAlignedObjectArray<btMatrix3x3> scratch_m_;
};

}  // namespace navvy::vehicle
