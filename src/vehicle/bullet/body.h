// SPDX-License-Identifier: Apache-2.0
// Articulated tree of one machine in Bullet [Featherstone 2008], addressed in the machine's own
// link frames.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <memory>
#include <vector>

#include "core/archive.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Owns Bullet's multibody of one machine.
///
/// Bullet requires link frames at the centres of mass along the principal axes; this class hides
/// them from its callers. It computes kinematics and momentum of the tree and applies impulses, but
/// it does not command joints.
///
/// Indices of links and joints are those of scene::Machine.
class TreeBody {
 public:
  /// Builds the tree of `machine`, with its model frame M at the pose `X_WM`.
  /// @throws InputError for joints that form no tree, or for a moving link without mass or inertia.
  TreeBody(const scene::Machine& machine, const Pose& X_WM);
  TreeBody(const TreeBody&) = delete;
  TreeBody& operator=(const TreeBody&) = delete;

  /// Returns Bullet's multibody, for constraints, colliders and the solver. Call moved() after
  /// changing its positions.
  btMultiBody& multibody() { return *body_; }
  /// Returns Bullet's link index of a joint; -1 for a joint that fixes the base to the world, which
  /// Bullet does not have.
  int bullet_of_joint(int joint) const { return bullet_of_joint_[index(joint)]; }
  /// Returns Bullet's link index of a link; -1 for the base.
  int bullet_of_link(int link) const { return bullet_of_link_[index(link)]; }
  /// Returns the link that belongs to Bullet's link index `bullet`; -1 means Bullet's base and
  /// gives link 0.
  int link_of_bullet(int bullet) const { return bullet < 0 ? 0 : link_of_bullet_[index(bullet)]; }
  /// Returns the pose of Bullet's frame of a link, at the link's centre of mass, in the link's own
  /// frame.
  const Pose& inertial_frame(int link) const { return X_LI_[index(link)]; }

  /// Returns the position [rad|m] of a revolute or prismatic joint; 0 for other joints.
  double position(int joint) const;
  /// Returns the velocity [rad/s|m/s] of a revolute or prismatic joint; 0 for other joints.
  double velocity(int joint) const;
  /// Returns the state of a link as of the end of the last step: without the velocity that
  /// impulses of a step have added since (apply_impulse()), with which nothing has moved yet.
  LinkState moved_link(int link) const;
  /// Returns the velocity [rad/s|m/s] of a joint as of the end of the last step, as moved_link().
  double moved_velocity(int joint) const;
  /// Sets the position of a revolute or prismatic joint to `q` [rad|m]. Velocities do not change.
  /// Does nothing for other joints.
  void set_position(int joint, double q);

  /// Returns pose and velocity in the world frame of a link, at the origin that the model defines
  /// for it.
  LinkState link(int link) const;
  /// Returns the centre of mass of a link in the world frame [m].
  Vec3 center(int link) const;
  /// Returns the mass of a link [kg].
  double mass(int link) const { return mass_[index(link)]; }
  /// Returns the total mass of all moving links [kg]; a fixed base is not included.
  double total_mass() const { return total_mass_; }
  /// Returns true if the base link is fixed to the world.
  bool fixed_base() const { return body_->hasFixedBase(); }
  /// Returns the linear momentum of all moving links in the world frame [N s].
  Vec3 momentum() const;
  /// Returns the origin of a joint in the world frame [m].
  Vec3 joint_origin(int joint) const;
  /// Returns the unit axis of a revolute or prismatic joint in the world frame.
  Vec3 joint_axis(int joint) const;
  /// Returns the inertia of all links that move with a joint, about its axis [kg m2] or, for a
  /// prismatic joint, along its axis [kg].
  double outward_inertia(int joint) const;

  /// Adds a force `f_W` [N] at the point `p_W` [m] and a moment `m_W` [N m] on a link for the next
  /// step.
  void add_force(int link, const Vec3& f_W, const Vec3& m_W, const Vec3& p_W);
  /// Applies an impulse `J_W` [N s] at the point `p_W` [m] and an angular impulse `L_W` [N m s] to
  /// a link. Velocities change at once, according to the tree's articulated inertia at the current
  /// pose.
  ///
  /// If `dt` [s] is positive and the body has no joints, its position also changes by `dt` times
  /// the change of velocity, and the next step expects the same impulse again (see
  /// step_velocities()).
  /// @return true if the position changed
  bool apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W, double dt);
  /// Computes the virtual work of an impulse on each degree of freedom into `work`, which holds 6 +
  /// the number of joint degrees of freedom. The order is Bullet's: base angular, base linear,
  /// joints.
  ///
  /// The impulse `J_W` [N s] acts at the point `p_W` [m] of a link, with the angular impulse `L_W`
  /// [N m s]. For a unit impulse without `L_W`, the result is the Jacobian row of the point's
  /// velocity along that impulse.
  void virtual_work(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
                    double* work) const;
  /// Computes the change `delta` of the generalised velocity by a generalised impulse `work`. Both
  /// have the size and order of virtual_work().
  void respond_to(const double* work, double* delta) const {
    update_factors();
    body_->calcAccelerationDeltasMultiDof(work, delta, scratch_r_, scratch_v_);
  }
  /// Returns the inverse of a link's articulated mass at the link's origin, in the order (angular,
  /// linear) and world axes.
  Mat6 inverse_mass(int link) const;

  /// Advances the velocities by gravity (in the world frame [m/s2]) and all added forces in one
  /// explicit step of `dt` [s].
  ///
  /// A body without joints also gains the velocity of its expected support, the mean of the
  /// impulses that apply_impulse() received in the last steps. The solver thus treats it as
  /// supported; step_positions() removes this velocity again.
  void step_velocities(const Vec3& gravity, double dt);
  /// Sets the velocities of all links to zero.
  void stop();
  /// Sets pose and velocity of the base link. Positions and velocities of the joints do not change.
  void set_base(const LinkState& link);
  /// Adds the solver's velocity changes, then advances the positions by `dt` [s].
  void step_positions(double dt);
  /// Marks all values computed from positions as outdated. Call it after changing positions through
  /// multibody().
  void moved() { kinematics_valid_ = factors_valid_ = false; }
  /// Moves the collision objects of all links to their current poses.
  void place_colliders();

  /// Saves, loads or hashes base pose, joint positions, velocities and expected support (see
  /// step_velocities()), which are the whole state of the tree between two steps.
  void visit(Archive& a);

 private:
  /// Pose and velocity of a link's inertial frame, which is Bullet's frame of the link.
  struct Frame {
    /// Pose of the link's inertial frame in the world frame.
    Pose X_WI = Pose::Identity();
    /// Velocity of the link's centre of mass [m/s] and angular velocity of the link [rad/s], in the
    /// world frame.
    Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();
  };
  /// Converts a non-negative index to std::size_t.
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  /// Returns the joints from the base outward, and numbers the links and joints of the tree in this
  /// order. Refuses links that no joint connects to the base.
  std::vector<int> order_outward(const scene::Machine& machine);
  /// Builds Bullet's tree outward from the base, in the order of the joints.
  void build(const scene::Machine& machine);
  /// Adds a joint and its child link to Bullet's tree as Bullet's link `bullet`.
  void add_joint(const scene::Machine& machine, int joint, int bullet);
  /// Returns the base position (3 values) and orientation (quaternion x, y, z, w), followed by the
  /// coordinates of every joint.
  std::vector<double> coordinates() const;
  /// Returns the generalised velocity: base angular, base linear, then joints in Bullet's order.
  std::vector<double> velocities() const;
  /// Sets coordinates and generalised velocity, in the order of coordinates() and velocities().
  void place(const std::vector<double>& coordinates, const std::vector<double>& velocities);
  /// Computes poses and velocities of all links, if they have changed since the last call.
  void update_kinematics() const;
  /// Computes the factors of the articulated inertia, if the pose has changed since the last call.
  void update_factors() const;
  /// Computes the change of the generalised velocity by an impulse into `delta`. The parameters are
  /// those of apply_impulse().
  void respond(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
               std::vector<double>& delta) const;
  /// Returns the velocity of a link's origin, (angular, linear) in the world frame, that belongs to
  /// the generalised velocity `velocity`.
  Vec6 twist_of(int link, const std::vector<double>& velocity) const;

  /// Bullet's multibody.
  std::unique_ptr<btMultiBody> body_;
  /// Maps between the machine's indices and Bullet's, in the direction that each name gives.
  /// Bullet's base is -1.
  std::vector<int> bullet_of_joint_, bullet_of_link_, link_of_bullet_, joint_of_bullet_;
  /// Pose of each link's inertial frame in the link's own frame.
  std::vector<Pose> X_LI_;
  /// Mass of each link [kg].
  std::vector<double> mass_;
  /// Inertia of each link about its centre of mass, in the axes of the link's own frame [kg m2].
  std::vector<Mat3> inertia_;
  /// Links that move with each of Bullet's joints, including the joint's own child.
  std::vector<std::vector<int>> outward_;
  /// Origin of each of Bullet's joints in the inertial frame of its child [m].
  std::vector<Vec3> pivot_I_;
  /// Total mass of all moving links [kg].
  double total_mass_ = 0;
  /// Impulse that is expected to support a body without joints in the next step, in the order
  /// (angular about the centre of mass, linear). `support_` is the impulse applied since the last
  /// step [N m s, N s], `bearing_` its mean over the last steps as a force [N m, N].
  Vec6 support_ = Vec6::Zero(), bearing_ = Vec6::Zero();
  /// Generalised velocities that impulses of a step have added since the last step; empty if there
  /// were none.
  std::vector<double> added_;
  /// Change of the generalised velocity that step_velocities() added for the expected support and
  /// step_positions() removes again; empty if there is none.
  std::vector<double> expected_;
  /// True while the stored kinematics, and the factors of the articulated inertia, match the
  /// current state.
  mutable bool kinematics_valid_ = false, factors_valid_ = false;
  /// Pose and velocity of each link's inertial frame.
  mutable std::vector<Frame> frames_;
  // Scratch memory for Bullet's algorithms.
  mutable btAlignedObjectArray<btScalar> scratch_r_;
  mutable btAlignedObjectArray<btVector3> scratch_v_;
  mutable btAlignedObjectArray<btMatrix3x3> scratch_m_;
};

}  // namespace navvy::vehicle
