// SPDX-License-Identifier: Apache-2.0
#include "vehicle/kinematics.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace navvy::vehicle {
namespace {

using JointType = scene::Joint::Type;

[[noreturn]] void refuse(const scene::Cylinder& cylinder, const std::string& value,
                         const std::string& rule) {
  Fault fault;
  fault.element = "cylinder[" + cylinder.name + "]";
  fault.value = value;
  fault.rule = rule;
  throw InputError(fault);
}

}  // namespace

// Cylinders side by side act as one of their summed area.
double head_area(const scene::Cylinder& cylinder) {
  return cylinder.count * kPi / 4 * cylinder.bore * cylinder.bore;
}

double rod_area(const scene::Cylinder& cylinder) {
  return cylinder.count * kPi / 4 * (cylinder.bore * cylinder.bore - cylinder.rod * cylinder.rod);
}

CylinderMap::CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder, Unchecked)
    : cylinder_(cylinder) {
  joint_ = machine.joint_index(cylinder.joint);
  if (joint_ < 0) refuse(cylinder, cylinder.joint, "no joint of this name");
  const scene::Joint& joint = machine.joints[static_cast<std::size_t>(joint_)];
  if (joint.type != JointType::kRevolute && joint.type != JointType::kPrismatic)
    refuse(cylinder, cylinder.joint, "a cylinder needs a revolute or prismatic joint");
  // Either end may be the parent: a boom's cylinder is attached to the chassis, a stick's to the
  // boom that carries it.
  const int base = machine.link_index(cylinder.base_link),
            rod = machine.link_index(cylinder.rod_link);
  if (base < 0) refuse(cylinder, cylinder.base_link, "no link of this name");
  if (rod < 0) refuse(cylinder, cylinder.rod_link, "no link of this name");
  const bool straight = base == joint.parent && rod == joint.child;
  base_is_child_ = base == joint.child && rod == joint.parent;
  if (!straight && !base_is_child_)
    refuse(cylinder, cylinder.base_link,
           "base_link and rod_link must be the two links of joint '" + joint.name + "'");
  base_link_ = base;
  prismatic_ = joint.type == JointType::kPrismatic;
  // Check a joint without limits over a whole turn.
  has_limits_ = joint.has_limits;
  lower_ = joint.has_limits ? joint.lower : -kPi;
  upper_ = joint.has_limits ? joint.upper : kPi;

  // Compute all constants here, so that a step costs one rotation and a few products.
  X_parent_pivot_ = joint_pose(machine, joint, 0) * joint.X_LcJ;
  X_pivot_child_ = joint.X_LcJ.inverse();
  axis_ = joint.axis.normalized();
  const Pose X_base_pivot = base_is_child_ ? joint.X_LcJ : X_parent_pivot_;
  p_joint_ = X_base_pivot.translation();
  // Moving the child by +q moves the parent by -q as seen from the child.
  axis_base_ = X_base_pivot.linear() * axis_ * (base_is_child_ ? -1.0 : 1.0);

  if (cylinder_.has_linkage) {
    // Choose the assembly (see the header) in the middle of the range and use it for every q.
    const Vec3 c = rod_in_base(0.5 * (lower_ + upper_)) * cylinder_.p_coupler;
    const Vec3 line = c - cylinder_.p_rocker;
    branch_ = axis_base_.dot(line.cross(p_joint_ - cylinder_.p_rocker)) > 0 ? -1 : 1;
  }
}

CylinderMap::CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder)
    : CylinderMap(machine, cylinder, Unchecked{}) {
  check();
}

// Inverts the joint's motion if the base is the child.
Pose CylinderMap::rod_in_base(double q) const {
  Pose motion = Pose::Identity();
  if (prismatic_)
    motion.translation() = q * axis_;
  else
    motion.linear() = Eigen::AngleAxisd(q, axis_).toRotationMatrix();
  // rod_link in base_link, whichever of them is the parent.
  const Pose X_parent_child = X_parent_pivot_ * motion * X_pivot_child_;
  return base_is_child_ ? X_parent_child.inverse() : X_parent_child;
}

// Intersects two circles and takes the chosen branch.
bool CylinderMap::close_linkage(const Vec3& c, Vec3& pin) const {
  // Two circles in the plane normal to the axis: about the rocker pivot and about the bucket's
  // coupler pin.
  const Vec3& r = cylinder_.p_rocker;
  // Project into the plane: pins may be offset from each other along the axis.
  Vec3 line = c - r;
  line -= axis_base_.dot(line) * axis_base_;
  // Intersection of the circles: position along the line and distance from it.
  const double d = std::max(line.norm(), 1e-9), a = cylinder_.rocker_coupler, b = cylinder_.coupler;
  const double along = (d * d + a * a - b * b) / (2 * d);
  const double across2 = a * a - along * along;
  const Vec3 u = line / d;
  // Out of reach, take the nearest point: numbers stay finite and the return value reports it.
  pin = r + along * u + branch_ * std::sqrt(std::max(across2, 0.0)) * axis_base_.cross(u);
  return across2 > 0;
}

// Length and lever follow from the pins and the velocity of the rod's pin.
CylinderGeometry CylinderMap::geometry(double q) const {
  CylinderGeometry g;
  const Pose X = rod_in_base(q);
  g.p_base = cylinder_.p_base;
  const auto velocity = [&](const Vec3& p) -> Vec3 {  // of a point of rod_link per unit of q
    return prismatic_ ? axis_base_ : Vec3(axis_base_.cross(p - p_joint_));
  };
  Vec3 v_rod;
  if (!cylinder_.has_linkage) {
    // Direct: the rod's pin moves with rod_link.
    g.p_rod = X * cylinder_.p_rod;
    v_rod = velocity(g.p_rod);
  } else {
    const Vec3 c = X * cylinder_.p_coupler;
    Vec3 pin;
    close_linkage(c, pin);
    const Vec3 arm = pin - cylinder_.p_rocker, bar = pin - c;
    // The pin turns about the rocker pivot, and the coupler's length is constant: (v_pin - v_c) .
    // bar = 0.
    const Vec3 turn = axis_base_.cross(arm);
    const double rate = velocity(c).dot(bar) / turn.dot(bar);
    const double share = cylinder_.rocker_rod / cylinder_.rocker_coupler;
    // Rod pin and coupler pin are on one ray of the rocker.
    g.p_rod = cylinder_.p_rocker + share * arm;
    v_rod = share * rate * turn;
  }
  // dl/dq is the rod pin's velocity along the cylinder.
  const Vec3 line = g.p_rod - g.p_base;
  g.length = line.norm();
  g.lever = g.length > 0 ? line.dot(v_rod) / g.length : 0;
  return g;
}

// Pressure x area x lever, and flow / (area x lever).
CylinderLimits CylinderMap::limits(const CylinderGeometry& g) const {
  const double head = head_area(cylinder_), rod = rod_area(cylinder_), lever = std::abs(g.lever);
  // A lever near zero would allow any speed; the lower bound keeps numbers finite.
  const double safe = std::max(lever, 1e-4);
  const double push = cylinder_.pressure * head * lever, pull = cylinder_.pressure * rod * lever;
  const double extend = cylinder_.flow / (head * safe), retract = cylinder_.flow / (rod * safe);
  // With a negative lever the extending cylinder turns the joint negatively: swap both sides.
  if (g.lever >= 0) return {push, pull, extend, retract};
  return {pull, push, retract, extend};
}

CylinderLimits CylinderMap::limits(double q) const { return limits(geometry(q)); }

// Samples the whole range of the joint.
void CylinderMap::check() const {
  if (cylinder_.bore <= 0 || cylinder_.rod < 0 || cylinder_.rod >= cylinder_.bore)
    refuse(cylinder_, std::to_string(cylinder_.rod),
           "rod must be less than bore, both [m] and positive");
  // A direct cylinder always closes; check a linkage over the whole range of the joint.
  if (!cylinder_.has_linkage || !has_limits_) return;
  constexpr int kSamples = 64;
  for (int i = 0; i <= kSamples; ++i) {
    const double q = lower_ + (upper_ - lower_) * i / kSamples;
    Vec3 pin;
    const Vec3 c = rod_in_base(q) * cylinder_.p_coupler;
    const bool closed = close_linkage(c, pin);
    // With arm and coupler in line the coupler cannot turn the bucket.
    const double sine =
        axis_base_.dot((pin - c).cross(c - p_joint_)) / ((pin - c).norm() * (c - p_joint_).norm());
    if (!closed || std::abs(sine) < 0.02)
      refuse(cylinder_, std::to_string(q),
             "the linkage cannot be closed, or is at a dead centre, at this joint position [rad]");
  }
}

CylinderGeometry cylinder_geometry(const scene::Machine& machine, const scene::Cylinder& cylinder,
                                   double q) {
  // For a single evaluation; engines store the map.
  return CylinderMap(machine, cylinder, CylinderMap::Unchecked{}).geometry(q);
}

CylinderLimits cylinder_limits(const scene::Machine& machine, const scene::Cylinder& cylinder,
                               double q) {
  return CylinderMap(machine, cylinder, CylinderMap::Unchecked{}).limits(q);
}

}  // namespace navvy::vehicle
