// SPDX-License-Identifier: Apache-2.0
// Forward kinematics and cylinder geometry of a machine's tree, without any engine.
//
// Signs: a joint's position is positive by the right hand about its axis (for the pitch joints of
// an excavator's arm, axis (0,-1,0), that lifts the link). A cylinder's force is positive when it
// pushes (extends). The lever is dl/dq, so by virtual work torque = force x lever: with a negative
// lever the extending cylinder turns the joint negatively. Extending fills the head side (bore
// area), retracting fills the rod side (bore minus rod area).
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Pose of the joint's child link in its parent link at joint position q (fixed and ball joints
/// ignore q).
Pose joint_pose(const scene::Machine& machine, const scene::Joint& joint, double q);

/// Poses of all links for base pose X_WB (pose of links[0]) and joint positions.
std::vector<Pose> forward_kinematics(const scene::Machine& machine, const Pose& X_WB,
                                     const std::vector<double>& q);

/// Cylinder length [m] and lever arm dl/dq [m/rad] at joint position q.
struct CylinderGeometry {
  double length = 0, lever = 0;
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();  ///< pins in base_link's frame [m]
};
CylinderGeometry cylinder_geometry(const scene::Machine& machine, const scene::Cylinder& cylinder,
                                   double q);

/// Largest torques [N m] (positive and negative direction of the joint) and speeds [rad/s] that the
/// cylinder allows at q. All four are magnitudes.
struct CylinderLimits {
  double torque_positive = 0, torque_negative = 0, speed_positive = 0, speed_negative = 0;
};
CylinderLimits cylinder_limits(const scene::Machine& machine, const scene::Cylinder& cylinder,
                               double q);

/// Areas [m2] of all `count` cylinders together.
double head_area(const scene::Cylinder& cylinder);
double rod_area(const scene::Cylinder& cylinder);

/// A cylinder with its names resolved, for evaluation in every step.
///
/// A four-bar linkage lies in the plane across the joint's axis: the rocker turns about `p_rocker`
/// on base_link; rod pin and coupler pin lie on one ray from that pivot. Of the two assemblies the
/// one is taken in which, in the middle of the joint's range, the rocker's coupler pin and the
/// joint lie on opposite sides of the line from rocker pivot to the bucket's coupler pin (the
/// convex four-bar), and it is kept over the whole range.
class CylinderMap {
 public:
  /// @throws InputError when a name is unknown, base_link and rod_link are not the two links of the
  /// joint, or the linkage cannot be closed or comes to a dead centre within the joint's limits.
  CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder);
  int joint() const { return joint_; }
  int base_link() const { return base_link_; }
  CylinderGeometry geometry(double q) const;
  CylinderLimits limits(double q) const;
  /// Of a geometry already worked out for the same q.
  CylinderLimits limits(const CylinderGeometry& geometry) const;

 private:
  friend CylinderGeometry cylinder_geometry(const scene::Machine&, const scene::Cylinder&, double);
  friend CylinderLimits cylinder_limits(const scene::Machine&, const scene::Cylinder&, double);
  struct Unchecked {};
  CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder, Unchecked);
  Pose rod_in_base(double q) const;
  /// Coupler pin of the rocker for the bucket's coupler pin c; false when the bars do not reach.
  bool close_linkage(const Vec3& c, Vec3& pin) const;
  void check() const;

  scene::Cylinder cylinder_;
  int joint_ = -1, base_link_ = -1;
  bool base_is_child_ = false, prismatic_ = false, has_limits_ = false;
  double lower_ = 0, upper_ = 0;
  Pose X_parent_pivot_ = Pose::Identity(),
       X_pivot_child_ = Pose::Identity();  // child = parent pivot, turned, then this
  Vec3 axis_ = Vec3::UnitZ();              // in the pivot frame
  // Joint origin and axis in base_link at q = 0; for a revolute joint they stay there for every q.
  Vec3 p_joint_ = Vec3::Zero(), axis_base_ = Vec3::UnitZ();
  double branch_ = 1;
};

}  // namespace navvy::vehicle
