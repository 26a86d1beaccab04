// SPDX-License-Identifier: Apache-2.0
// Forward kinematics and cylinder geometry of a machine's tree, independent of any engine.
//
// Signs: a joint's position is positive by the right-hand rule about its axis (for the pitch joints
// of an excavator's arm, axis (0,-1,0), this lifts the link). A cylinder's force is positive when
// it extends. The lever is dl/dq, so by virtual work torque = force x lever: with a negative lever
// the extending cylinder turns the joint negatively. Extending fills the head side (bore area),
// retracting fills the rod side (bore minus rod area).
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Returns the pose of the joint's child link in its parent link at joint position q. Fixed and
/// ball joints ignore q.
Pose joint_pose(const scene::Machine& machine, const scene::Joint& joint, double q);

/// Returns the poses of all links for base pose X_WB (pose of links[0]) and joint positions `q`.
std::vector<Pose> forward_kinematics(const scene::Machine& machine, const Pose& X_WB,
                                     const std::vector<double>& q);

/// Cylinder length [m] and lever arm dl/dq [m/rad] at a joint position.
struct CylinderGeometry {
  double length = 0, lever = 0;
  /// Pins in base_link's frame [m].
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();
};
/// Computes the geometry of a cylinder once; CylinderMap is faster for repeated use.
CylinderGeometry cylinder_geometry(const scene::Machine& machine, const scene::Cylinder& cylinder,
                                   double q);

/// Largest torques [N m] (positive and negative direction of the joint) and speeds [rad/s] that a
/// cylinder allows at a joint position, as magnitudes.
struct CylinderLimits {
  double torque_positive = 0, torque_negative = 0, speed_positive = 0, speed_negative = 0;
};
/// Computes the limits of a cylinder once; CylinderMap is faster for repeated use.
CylinderLimits cylinder_limits(const scene::Machine& machine, const scene::Cylinder& cylinder,
                               double q);

/// Returns the area [m2] of all `count` cylinders together.
double head_area(const scene::Cylinder& cylinder);
double rod_area(const scene::Cylinder& cylinder);

/// Cylinder with resolved names, for evaluation in every step.
///
/// A four-bar linkage is in the plane normal to the joint's axis: the rocker turns about `p_rocker`
/// on base_link; rod pin and coupler pin are on one ray from that pivot. Of the two assemblies the
/// convex four-bar is used: in the middle of the joint's range, the rocker's coupler pin and the
/// joint are on opposite sides of the line from the rocker pivot to the bucket's coupler pin. The
/// assembly is the same over the whole range.
class CylinderMap {
 public:
  /// Resolves the names.
  /// @throws InputError if a name is unknown, if base_link and rod_link are not the two links of
  /// the joint, or if the linkage cannot be closed or reaches a dead centre within the joint's
  /// limits.
  CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder);
  /// Returns the index of the joint that the cylinder moves.
  int joint() const { return joint_; }
  /// Returns the index of the link that carries the cylinder's base.
  int base_link() const { return base_link_; }
  /// Returns length, lever and pins at joint position q.
  CylinderGeometry geometry(double q) const;
  /// Returns the limits of torque and speed at joint position q.
  CylinderLimits limits(double q) const;
  /// Returns the limits for a geometry already computed for the same q.
  CylinderLimits limits(const CylinderGeometry& geometry) const;

 private:
  friend CylinderGeometry cylinder_geometry(const scene::Machine&, const scene::Cylinder&, double);
  friend CylinderLimits cylinder_limits(const scene::Machine&, const scene::Cylinder&, double);
  struct Unchecked {};
  CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder, Unchecked);
  /// Returns the pose of rod_link in base_link at joint position q.
  Pose rod_in_base(double q) const;
  /// Computes the coupler pin of the rocker for the bucket's coupler pin c. Returns false if the
  /// bars do not reach.
  bool close_linkage(const Vec3& c, Vec3& pin) const;
  /// @throws InputError if the linkage does not close within the joint's limits.
  void check() const;

  scene::Cylinder cylinder_;
  int joint_ = -1, base_link_ = -1;
  bool base_is_child_ = false, prismatic_ = false, has_limits_ = false;
  double lower_ = 0, upper_ = 0;
  Pose X_parent_pivot_ = Pose::Identity(),
       // The child frame is the parent pivot, rotated, then X_pivot_child_.
      X_pivot_child_ = Pose::Identity();
  Vec3 axis_ = Vec3::UnitZ();  // in the pivot frame
  // Joint origin and axis in base_link at q = 0. For a revolute joint they are the same at every q.
  Vec3 p_joint_ = Vec3::Zero(), axis_base_ = Vec3::UnitZ();
  double branch_ = 1;
};

}  // namespace navvy::vehicle
