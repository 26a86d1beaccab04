// SPDX-License-Identifier: Apache-2.0
// Geometry of a machine's cylinders, beside the forward kinematics of its links
// (scene/kinematics.h). Independent of the physics engine.
//
// Signs: a joint's position is positive by the right-hand rule about its axis. For the pitch joints
// of an excavator's arm, whose axis is (0,-1,0), positive rotation lifts the link. A cylinder's
// force is positive when it extends the cylinder. The lever arm is dl/dq, the derivative of the
// cylinder's length with respect to the joint's position. By virtual work, torque = force x lever;
// with a negative lever arm, the extending cylinder turns the joint in its negative direction.
// Extending fills the head side (bore area), retracting fills the rod side (bore minus rod area).
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/forward_kinematics.h"
#include "scene/machine.h"

namespace navvy::vehicle {

using scene::forward_kinematics;
using scene::joint_pose;

/// Geometry of a hydraulic cylinder at one joint position.
struct CylinderGeometry {
  /// Distance between the cylinder's pins [m], and its lever arm dl/dq [m/rad]; the lever of a
  /// prismatic joint is dimensionless.
  double length = 0, lever = 0;
  /// Pin of the barrel and pin of the rod, both in base_link's frame [m].
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();
};
/// Returns the geometry of `cylinder` at joint position `q`. For repeated evaluation, CylinderMap
/// is faster.
/// @throws InputError for unknown names of joint or links.
CylinderGeometry cylinder_geometry(const scene::Machine& machine, const scene::Cylinder& cylinder,
                                   double q);

/// Limits that a hydraulic cylinder imposes on its joint at one joint position, as magnitudes.
struct CylinderLimits {
  /// Largest torques [N m|N] and speeds [rad/s|m/s] in the positive and in the negative direction
  /// of the joint.
  double torque_positive = 0, torque_negative = 0, speed_positive = 0, speed_negative = 0;
};
/// Returns the limits that `cylinder` imposes on its joint at joint position `q`. For repeated
/// evaluation, CylinderMap is faster.
/// @throws InputError for unknown names of joint or links.
CylinderLimits cylinder_limits(const scene::Machine& machine, const scene::Cylinder& cylinder,
                               double q);

/// Returns the total piston area on the head side (bore) of all cylinder.count cylinders [m2].
double head_area(const scene::Cylinder& cylinder);
/// Returns the total piston area on the rod side (bore minus rod) of all cylinder.count cylinders
/// [m2].
double rod_area(const scene::Cylinder& cylinder);

/// Hydraulic cylinder that moves one joint of a machine. Stores indices instead of the names in the
/// scene, so that it is fast enough to evaluate in every step.
///
/// The rod moves its link directly or through a four-bar linkage. The linkage is in the plane
/// normal to the joint's axis and consists of four bars: base_link, rod_link, a rocker and a
/// coupler. The rocker turns about its pivot on base_link. It carries the pin of the rod and one
/// pin of the coupler, both in the same direction from the pivot; the coupler's other pin is on
/// rod_link.
///
/// Four bars of given lengths can be assembled in two ways for each joint position. This class uses
/// the convex one, in which the line from the rocker's pivot to the coupler's pin on rod_link
/// passes between the joint and the coupler's pin on the rocker. It selects that assembly in the
/// middle of the joint's range and keeps it over the whole range.
class CylinderMap {
 public:
  /// Resolves the names of `cylinder` in `machine` and checks its geometry.
  /// @throws InputError if a name is unknown, if base_link and rod_link are not the two links of
  /// the joint, if the rod is not thinner than the bore, or if the linkage cannot be closed or
  /// reaches a dead centre within the joint's limits.
  CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder);
  /// Returns the index of the joint that the cylinder moves.
  int joint() const { return joint_; }
  /// Returns the index of the link that carries the barrel of the cylinder.
  int base_link() const { return base_link_; }
  /// Returns the cylinder's length, lever arm and pins at joint position `q` [rad|m].
  CylinderGeometry geometry(double q) const;
  /// Returns the limits of the joint's torque and speed at joint position `q` [rad|m].
  CylinderLimits limits(double q) const;
  /// Returns the limits of the joint's torque and speed for a geometry that geometry() has already
  /// computed.
  CylinderLimits limits(const CylinderGeometry& geometry) const;

 private:
  friend CylinderGeometry cylinder_geometry(const scene::Machine&, const scene::Cylinder&, double);
  friend CylinderLimits cylinder_limits(const scene::Machine&, const scene::Cylinder&, double);
  /// Selects the constructor that does not check the linkage.
  struct Unchecked {};
  /// Resolves the names without checking that the linkage closes.
  CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder, Unchecked);
  /// Returns the pose of rod_link in base_link at joint position `q`.
  Pose rod_in_base(double q) const;
  /// Computes `pin`, the position of the pin between rocker and coupler, if the coupler's other pin
  /// is at `c`, both in base_link's frame [m]. Returns false if rocker and coupler are too short or
  /// too long to meet; `pin` is then the nearest point.
  bool close_linkage(const Vec3& c, Vec3& pin) const;
  /// Checks the diameters, and that the linkage closes within the joint's limits.
  /// @throws InputError otherwise.
  void check() const;

  /// Properties of the cylinder as given in the scene.
  scene::Cylinder cylinder_;
  /// Indices of the joint that the cylinder moves, and of the link that carries its barrel.
  int joint_ = -1, base_link_ = -1;
  /// True if base_link is the joint's child; if the joint is prismatic; if the joint has limits.
  bool base_is_child_ = false, prismatic_ = false, has_limits_ = false;
  /// Range of the joint [rad|m]; +-pi without limits.
  double lower_ = 0, upper_ = 0;
  /// Pose of the joint frame in the parent link, and pose of the child link in the joint frame
  /// after the joint's motion.
  Pose X_parent_pivot_ = Pose::Identity(), X_pivot_child_ = Pose::Identity();
  /// Unit axis of the joint in the pivot frame.
  Vec3 axis_ = Vec3::UnitZ();
  /// Origin [m] and unit axis of the joint in base_link at q = 0. For a revolute joint they are the
  /// same at every q.
  Vec3 p_joint_ = Vec3::Zero(), axis_base_ = Vec3::UnitZ();
  /// Sign that selects one of the two assemblies of the linkage, 1 or -1.
  double branch_ = 1;
};

}  // namespace navvy::vehicle
