// SPDX-License-Identifier: Apache-2.0
// Statics of a machine that stands on level, firm ground: the efforts that its joints need and can
// apply, and its weight on its support polygon. Independent of the physics engine.
#pragma once

#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "vehicle/bullet/hydraulics.h"

namespace navvy::vehicle {

/// Indices of an arm's joints in scene::Machine::joints; -1 for a joint that the arm lacks.
struct ArmJoints {
  /// Joints of the upper structure, the boom, the stick and the bucket.
  int swing = -1, boom = -1, stick = -1, bucket = -1;
};
/// Returns the indices of the joints that the machine's `navvy:arm` names.
ArmJoints arm_joints(const scene::Machine& machine);

/// Returns the bucket on the link that the arm's bucket joint moves; null if there is none.
const scene::Bucket* arm_bucket(const scene::Machine& machine);

/// A machine that stands still on level, firm ground with its base upright.
///
/// The machine's frame is the world frame W. Positions of joints follow set(); a call of place()
/// evaluates links, cylinders and centre of mass. One evaluation costs some 10 us.
class MachineAtRest {
 public:
  /// Resolves joints and cylinders; all joints are at their initial positions. `machine` must exist
  /// as long as this object.
  /// @throws InputError as Hydraulics does.
  explicit MachineAtRest(const scene::Machine& machine);

  /// Sets the position of a joint [rad|m], clamped to its limits; place() makes it effective.
  void set(int joint, double q);
  /// Evaluates the machine at the positions that were set.
  void place();

  /// Returns the machine.
  const scene::Machine& machine() const { return machine_; }
  /// Returns the position of a joint [rad|m].
  double position(int joint) const { return q_[static_cast<std::size_t>(joint)]; }
  /// Returns the pose of a link.
  const Pose& link(int index) const { return X_WL_[static_cast<std::size_t>(index)]; }
  /// Returns the origin of a joint [m].
  Vec3 origin(int joint) const;
  /// Returns the unit axis of a joint.
  Vec3 axis(int joint) const;
  /// Returns true if the machine cannot move on the ground: its base is fixed to the world, or it
  /// has no wheels.
  bool is_anchored() const { return machine_.fixed_base || machine_.wheels.empty(); }
  /// Returns the points on which the machine stands, seen from above [m]; none if it is anchored.
  const std::vector<Vec2>& support_points() const { return support_points_; }
  /// Returns the height of the lowest support point, which is the ground [m]; 0 if the machine is
  /// anchored.
  double ground() const { return ground_; }
  /// Returns the mass of the machine [kg].
  double mass() const { return mass_; }
  /// Returns the centre of mass of the machine [m].
  const Vec3& centre() const { return centre_; }

  /// Returns the effort [N m|N] that the joint must apply to hold the weight of all links beyond
  /// it.
  double weight_effort(int joint) const;
  /// Returns the effort [N m|N] that the joint must apply to resist the force `f` [N] at the point
  /// `p` [m] of a link beyond it.
  double force_effort(int joint, const Vec3& p, const Vec3& f) const;
  /// Returns the largest effort [N m|N] that the joint can apply in its positive or its negative
  /// direction, as a magnitude: the smaller one of the joint's own and its cylinder's.
  double effort_limit(int joint, bool positive) const;
  /// Returns the name of what limits the joint's effort: its cylinder, or the joint itself.
  std::string circuit(int joint) const;

 private:
  const scene::Machine& machine_;
  Hydraulics hydraulics_;
  std::vector<double> q_;
  std::vector<Pose> X_WL_;
  std::vector<Vec2> support_points_;
  /// Links beyond each joint.
  std::vector<std::vector<int>> beyond_;
  Vec3 centre_ = Vec3::Zero();
  double mass_ = 0, ground_ = 0;
};

/// Returns the sense in which a joint of the arm digs, 1 or -1: that in which the edge of `bucket`,
/// the arm's, moves along its cutting direction.
double digging_sense(const MachineAtRest& rest, const scene::Bucket& bucket, int joint);

}  // namespace navvy::vehicle
