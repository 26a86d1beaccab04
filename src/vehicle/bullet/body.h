// SPDX-License-Identifier: Apache-2.0
// One machine as an articulated tree of Bullet [Featherstone 2008], seen in the machine's own link
// frames.
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
/// Bullet wants link frames at the centres of mass along the principal axes; this class keeps that
/// to itself. It knows kinematics and momentum of the tree and answers impulses; it commands
/// nothing.
class TreeBody {
 public:
  /// @throws InputError for a joint that is no tree, or a moving link without mass or inertia.
  TreeBody(const scene::Machine& machine, const Pose& X_WM);
  TreeBody(const TreeBody&) = delete;
  TreeBody& operator=(const TreeBody&) = delete;

  /// For constraints, colliders and the solver; whoever moves it says so by moved().
  btMultiBody& multibody() { return *body_; }
  /// Bullet's link of a joint; -1: none (a joint of the base to the world).
  int bullet_of_joint(int joint) const { return bullet_of_joint_[index(joint)]; }
  int bullet_of_link(int link) const { return bullet_of_link_[index(link)]; }
  /// The link of a number of Bullet's; its base is -1.
  int link_of_bullet(int bullet) const { return bullet < 0 ? 0 : link_of_bullet_[index(bullet)]; }
  /// Pose of Bullet's frame of a link in the link.
  const Pose& inertial_frame(int link) const { return X_LI_[index(link)]; }

  /// Of a joint with one freedom [rad|m], [rad/s|m/s]; 0 of others.
  double position(int joint) const;
  double velocity(int joint) const;
  /// Puts a joint to q; velocities stay.
  void set_position(int joint, double q);

  /// Pose and velocity of a link's own frame, as the model has it.
  LinkState link(int link) const;
  Vec3 center(int link) const;  ///< of mass, in W [m]
                                /// [kg]
  double mass(int link) const { return mass_[index(link)]; }
  /// Of all that moves [kg]: without a fixed base.
  double total_mass() const { return total_mass_; }
  bool fixed_base() const { return body_->hasFixedBase(); }
  /// Of all moving parts [N s].
  Vec3 momentum() const;
  /// Origin [m] and axis of a joint in W.
  Vec3 joint_origin(int joint) const;
  Vec3 joint_axis(int joint) const;
  /// Inertia [kg m2|kg] of everything outward of the joint, about or along its axis.
  double outward_inertia(int joint) const;

  /// Adds a force [N] with moment [N m] about p_W for the next step.
  void add_force(int link, const Vec3& f_W, const Vec3& m_W, const Vec3& p_W);
  /// Changes velocities at once, exactly, as the articulated inertia is that of the present pose,
  /// and the place of a body without joints by dt [s] times that change. Whether it moved. What
  /// moved it is expected of the next step, too.
  bool apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W, double dt);
  /// Virtual work of an impulse on each freedom, as Bullet orders them: base (angular, linear),
  /// then joints. `work` holds 6 + their number. For a unit impulse without moment it is the row
  /// that tells a point's velocity along it.
  void virtual_work(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
                    double* work) const;
  /// Inverse articulated mass at the link's origin, (angular, linear), W axes.
  Mat6 inverse_mass(int link) const;

  /// Gravity and added forces change the velocities by one explicit step. For the solver alone a
  /// body without joints also has what bears it, the mean of the last impulses of steps
  /// (apply_impulse); step_positions takes it away again.
  void step_velocities(const Vec3& gravity, double dt);
  /// Takes all speed from it.
  void stop();
  /// Puts the base's link there, whatever it was, at this speed; the joints stay.
  void set_base(const LinkState& link);
  /// The solver's velocity changes, then positions.
  void step_positions(double dt);
  /// Positions changed from outside: what was worked out from them is void.
  void moved() { kinematics_valid_ = factors_valid_ = false; }
  /// Collision objects to the poses of now.
  void place_colliders();

  /// Base pose, joint positions, velocities, what bears it: all the tree's state between two steps.
  void visit(Archive& a);

 private:
  struct Frame {
    Pose X_WI = Pose::Identity();
    Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();  // of the centre of mass
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  /// Links outward from the base, in the order of the joints.
  void build(const scene::Machine& machine);
  void add_joint(const scene::Machine& machine, int joint, int bullet);
  /// Base place and turn, then every joint's coordinates; the generalised velocity, as
  /// getVelocityVector has it.
  std::vector<double> coordinates() const;
  std::vector<double> velocities() const;
  void place(const std::vector<double>& coordinates, const std::vector<double>& velocities);
  /// Poses and velocities of all links, and the articulated inertias, each once after a change.
  void update_kinematics() const;
  void update_factors() const;
  /// Generalised velocity change by an impulse.
  void respond(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
               std::vector<double>& delta) const;
  /// Velocity of a link's origin that belongs to a generalised velocity, (angular, linear).
  Vec6 twist_of(int link, const std::vector<double>& velocity) const;

  std::unique_ptr<btMultiBody> body_;
  // Both ways between the machine's indices and Bullet's; Bullet's base is -1.
  std::vector<int> bullet_of_joint_, bullet_of_link_, link_of_bullet_, joint_of_bullet_;
  // By link: inertial frame in the link, mass [kg], inertia about the centre in the link's axes
  // [kg m2].
  std::vector<Pose> X_LI_;
  std::vector<double> mass_;
  std::vector<Mat3> inertia_;
  std::vector<std::vector<int>> outward_;  // links outward of each Bullet link, itself included
  std::vector<Vec3> pivot_I_;              // joint origin in the child's Bullet frame
  double total_mass_ = 0;
  // Of a body without joints, (angular about its centre, linear): impulse since the last step
  // [N m s, N s], its mean as a force [N m, N], and the velocities that the solver has by that.
  Vec6 borne_ = Vec6::Zero(), bearing_ = Vec6::Zero();
  std::vector<double> expected_;
  // Worked out when asked for; Bullet wants scratch memory of its own.
  mutable bool kinematics_valid_ = false, factors_valid_ = false;
  mutable std::vector<Frame> frames_;  // by link
  mutable btAlignedObjectArray<btScalar> scratch_r_;
  mutable btAlignedObjectArray<btVector3> scratch_v_;
  mutable btAlignedObjectArray<btMatrix3x3> scratch_m_;
};

}  // namespace navvy::vehicle
