// SPDX-License-Identifier: Apache-2.0
#include "vehicle/kinematics.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace navvy::vehicle {
namespace {

using JointType = scene::Joint::Type;

Pose joint_motion(const scene::Joint& joint, double q) {
  Pose X = Pose::Identity();
  if (joint.type == JointType::kRevolute)
    X.linear() = Eigen::AngleAxisd(q, joint.axis.normalized()).toRotationMatrix();
  if (joint.type == JointType::kPrismatic) X.translation() = q * joint.axis.normalized();
  return X;
}

const scene::Link& link_of(const scene::Machine& machine, int index) {
  return machine.links[static_cast<std::size_t>(index)];
}

[[noreturn]] void refuse(const scene::Cylinder& cylinder, const std::string& value,
                         const std::string& rule) {
  Fault fault;
  fault.element = "cylinder[" + cylinder.name + "]";
  fault.value = value;
  fault.rule = rule;
  throw InputError(fault);
}

}  // namespace

Pose joint_pose(const scene::Machine& machine, const scene::Joint& joint, double q) {
  // Child in parent at 0, then the joint's motion in the joint's own frame, which sits in the
  // child.
  const Pose X_MC = link_of(machine, joint.child).X_ML;
  const Pose X_PC0 = joint.parent < 0 ? X_MC : link_of(machine, joint.parent).X_ML.inverse() * X_MC;
  return X_PC0 * joint.X_LcJ * joint_motion(joint, q) * joint.X_LcJ.inverse();
}

std::vector<Pose> forward_kinematics(const scene::Machine& machine, const Pose& X_WB,
                                     const std::vector<double>& q) {
  std::vector<Pose> poses(machine.links.size(), X_WB);
  std::vector<char> placed(machine.links.size(), 0);
  if (poses.empty()) return poses;
  placed[0] = 1;
  // Joints may be listed in any order: sweep until nothing more hangs on a placed link (once for an
  // ordered tree).
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t j = 0; j < machine.joints.size(); ++j) {
      const scene::Joint& joint = machine.joints[j];
      if (joint.parent < 0 || joint.child < 0) continue;
      const auto parent = static_cast<std::size_t>(joint.parent),
                 child = static_cast<std::size_t>(joint.child);
      if (!placed[parent] || placed[child]) continue;
      poses[child] =
          poses[parent] * joint_pose(machine, joint, j < q.size() ? q[j] : joint.initial);
      placed[child] = 1;
      moved = true;
    }
  }
  return poses;
}

// Side by side they act as one of their summed area.
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
  // Either end may be the parent: a boom's cylinder stands on the chassis, a stick's on the boom it
  // is pinned to.
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
  // A joint without limits is looked at over a whole turn.
  has_limits_ = joint.has_limits;
  lower_ = joint.has_limits ? joint.lower : -kPi;
  upper_ = joint.has_limits ? joint.upper : kPi;

  // What never changes is worked out here, so that a step costs one rotation and a few products.
  X_parent_pivot_ = joint_pose(machine, joint, 0) * joint.X_LcJ;
  X_pivot_child_ = joint.X_LcJ.inverse();
  axis_ = joint.axis.normalized();
  const Pose X_base_pivot = base_is_child_ ? joint.X_LcJ : X_parent_pivot_;
  p_joint_ = X_base_pivot.translation();
  // Moving the child by +q moves the parent by -q as seen from the child.
  axis_base_ = X_base_pivot.linear() * axis_ * (base_is_child_ ? -1.0 : 1.0);

  if (cylinder_.has_linkage) {
    // Which of the two assemblies: see the header. Decided in the middle, kept for every q.
    const Vec3 c = rod_in_base(0.5 * (lower_ + upper_)) * cylinder_.p_coupler;
    const Vec3 line = c - cylinder_.p_rocker;
    branch_ = axis_base_.dot(line.cross(p_joint_ - cylinder_.p_rocker)) > 0 ? -1 : 1;
  }
}

CylinderMap::CylinderMap(const scene::Machine& machine, const scene::Cylinder& cylinder)
    : CylinderMap(machine, cylinder, Unchecked{}) {
  check();
}

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

bool CylinderMap::close_linkage(const Vec3& c, Vec3& pin) const {
  // Two circles in the plane across the axis: about the rocker pivot and about the bucket's coupler
  // pin.
  const Vec3& r = cylinder_.p_rocker;
  // Flattened into the plane: pins may lie beside each other along the axis.
  Vec3 line = c - r;
  line -= axis_base_.dot(line) * axis_base_;
  // Intersection of the circles: how far along the line, and how far across it.
  const double d = std::max(line.norm(), 1e-9), a = cylinder_.rocker_coupler, b = cylinder_.coupler;
  const double along = (d * d + a * a - b * b) / (2 * d);
  const double across2 = a * a - along * along;
  const Vec3 u = line / d;
  // Out of reach the nearest point is taken: numbers stay finite, and the caller is told.
  pin = r + along * u + branch_ * std::sqrt(std::max(across2, 0.0)) * axis_base_.cross(u);
  return across2 > 0;
}

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
    // The pin turns about the rocker pivot, and the coupler keeps its length: (v_pin - v_c) . bar =
    // 0.
    const Vec3 turn = axis_base_.cross(arm);
    const double rate = velocity(c).dot(bar) / turn.dot(bar);
    const double share = cylinder_.rocker_rod / cylinder_.rocker_coupler;
    // Rod pin and coupler pin lie on one ray of the rocker.
    g.p_rod = cylinder_.p_rocker + share * arm;
    v_rod = share * rate * turn;
  }
  // dl/dq is the rod pin's velocity along the cylinder.
  const Vec3 line = g.p_rod - g.p_base;
  g.length = line.norm();
  g.lever = g.length > 0 ? line.dot(v_rod) / g.length : 0;
  return g;
}

CylinderLimits CylinderMap::limits(const CylinderGeometry& g) const {
  const double head = head_area(cylinder_), rod = rod_area(cylinder_), lever = std::abs(g.lever);
  // A lever near zero would allow any speed; the floor keeps numbers finite.
  const double safe = std::max(lever, 1e-4);
  const double push = cylinder_.pressure * head * lever, pull = cylinder_.pressure * rod * lever;
  const double extend = cylinder_.flow / (head * safe), retract = cylinder_.flow / (rod * safe);
  // With a negative lever the extending cylinder turns the joint negatively: the two sides change
  // places.
  if (g.lever >= 0) return {push, pull, extend, retract};
  return {pull, push, retract, extend};
}

CylinderLimits CylinderMap::limits(double q) const { return limits(geometry(q)); }

void CylinderMap::check() const {
  if (cylinder_.bore <= 0 || cylinder_.rod < 0 || cylinder_.rod >= cylinder_.bore)
    refuse(cylinder_, std::to_string(cylinder_.rod),
           "rod must be less than bore, both [m] and positive");
  // A direct cylinder always closes; a linkage is tried over the whole range of the joint.
  if (!cylinder_.has_linkage || !has_limits_) return;
  constexpr int kSamples = 64;
  for (int i = 0; i <= kSamples; ++i) {
    const double q = lower_ + (upper_ - lower_) * i / kSamples;
    Vec3 pin;
    const Vec3 c = rod_in_base(q) * cylinder_.p_coupler;
    const bool closed = close_linkage(c, pin);
    // Arm and coupler in line: the coupler's push no longer turns the bucket.
    const double sine =
        axis_base_.dot((pin - c).cross(c - p_joint_)) / ((pin - c).norm() * (c - p_joint_).norm());
    if (!closed || std::abs(sine) < 0.02)
      refuse(cylinder_, std::to_string(q),
             "the linkage cannot be closed, or is at a dead centre, at this joint position [rad]");
  }
}

CylinderGeometry cylinder_geometry(const scene::Machine& machine, const scene::Cylinder& cylinder,
                                   double q) {
  // For a look at one place; engines keep the map.
  return CylinderMap(machine, cylinder, CylinderMap::Unchecked{}).geometry(q);
}

CylinderLimits cylinder_limits(const scene::Machine& machine, const scene::Cylinder& cylinder,
                               double q) {
  return CylinderMap(machine, cylinder, CylinderMap::Unchecked{}).limits(q);
}

}  // namespace navvy::vehicle
