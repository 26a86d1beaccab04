// SPDX-License-Identifier: Apache-2.0
#include "vehicle/rating/machine_at_rest.h"

#include <algorithm>
#include <limits>

#include "vehicle/stability.h"

namespace navvy::vehicle {

ArmJoints arm_joints(const scene::Machine& machine) {
  return {machine.joint_index(machine.arm.swing), machine.joint_index(machine.arm.boom),
          machine.joint_index(machine.arm.stick), machine.joint_index(machine.arm.bucket)};
}

const scene::Bucket* arm_bucket(const scene::Machine& machine) {
  const int joint = machine.joint_index(machine.arm.bucket);
  if (joint < 0) return nullptr;
  const int link = machine.joints[static_cast<std::size_t>(joint)].child;
  for (const scene::Bucket& bucket : machine.buckets)
    if (machine.link_index(bucket.link) == link) return &bucket;
  return nullptr;
}

// The cutting direction is fixed in the bucket, so the sense is the same in every position.
double digging_sense(const MachineAtRest& rest, const scene::Bucket& bucket, int joint) {
  const int curls = rest.machine().joint_index(rest.machine().arm.bucket);
  const Pose& X_WB = rest.link(rest.machine().joints[static_cast<std::size_t>(curls)].child);
  const Vec3 axis = rest.axis(curls);
  const Vec3 along = axis.cross(X_WB * bucket.p_tip - rest.origin(curls));
  const double sense = along.dot(X_WB.linear() * bucket.cut_direction) < 0 ? -1 : 1;
  return axis.dot(rest.axis(joint)) < 0 ? -sense : sense;
}

// Links are in tree order, so one pass finds everything beyond a joint.
MachineAtRest::MachineAtRest(const scene::Machine& machine)
    : machine_(machine), hydraulics_(machine), beyond_(machine.joints.size()) {
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    q_.push_back(machine.joints[j].initial);
    std::vector<char> carried(machine.links.size(), 0);
    carried[static_cast<std::size_t>(machine.joints[j].child)] = 1;
    for (const scene::Joint& joint : machine.joints)
      if (joint.parent >= 0 && carried[static_cast<std::size_t>(joint.parent)] != 0)
        carried[static_cast<std::size_t>(joint.child)] = 1;
    for (std::size_t l = 0; l < carried.size(); ++l)
      if (carried[l] != 0) beyond_[j].push_back(static_cast<int>(l));
  }
  mass_ = machine.total_mass();
  place();
}

void MachineAtRest::set(int joint, double q) {
  const scene::Joint& about = machine_.joints[static_cast<std::size_t>(joint)];
  q_[static_cast<std::size_t>(joint)] =
      about.has_limits ? std::clamp(q, about.lower, about.upper) : q;
}

void MachineAtRest::place() {
  X_WL_ = forward_kinematics(machine_, machine_.links.front().X_ML, q_);
  for (int c = 0; c < hydraulics_.count(); ++c)
    hydraulics_.place(c, q_[static_cast<std::size_t>(hydraulics_.joint(c))]);
  centre_ = centre_of_mass(machine_, X_WL_);
  support_points_.clear();
  ground_ = 0;
  if (is_anchored()) return;
  ground_ = std::numeric_limits<double>::infinity();
  for (const Vec3& p : vehicle::support_points(machine_, X_WL_)) {
    support_points_.emplace_back(p.head<2>());
    ground_ = std::min(ground_, p.z());
  }
}

Vec3 MachineAtRest::origin(int joint) const {
  const scene::Joint& about = machine_.joints[static_cast<std::size_t>(joint)];
  return link(about.child) * Vec3(about.X_LcJ.translation());
}

Vec3 MachineAtRest::axis(int joint) const {
  const scene::Joint& about = machine_.joints[static_cast<std::size_t>(joint)];
  return link(about.child).linear() * about.X_LcJ.linear() * about.axis.normalized();
}

// Virtual work: the effort times a small motion lifts the weights by that motion.
double MachineAtRest::weight_effort(int joint) const {
  double out = 0;
  for (const int l : beyond_[static_cast<std::size_t>(joint)]) {
    const scene::Link& about = machine_.links[static_cast<std::size_t>(l)];
    out += force_effort(joint, link(l) * about.p_LCom, Vec3(0, 0, -kGravity * about.mass));
  }
  return out;
}

double MachineAtRest::force_effort(int joint, const Vec3& p, const Vec3& f) const {
  const bool slides =
      machine_.joints[static_cast<std::size_t>(joint)].type == scene::Joint::Type::kPrismatic;
  return slides ? -axis(joint).dot(f) : -axis(joint).dot((p - origin(joint)).cross(f));
}

double MachineAtRest::effort_limit(int joint, bool positive) const {
  const double own = machine_.joints[static_cast<std::size_t>(joint)].effort;
  const int cylinder = hydraulics_.of_joint(joint);
  if (cylinder < 0) return own;
  const CylinderLimits& limits = hydraulics_.limits(cylinder);
  return std::min(own, positive ? limits.torque_positive : limits.torque_negative);
}

std::string MachineAtRest::circuit(int joint) const {
  const int cylinder = hydraulics_.of_joint(joint);
  return cylinder < 0 ? machine_.joints[static_cast<std::size_t>(joint)].name
                      : machine_.cylinders[static_cast<std::size_t>(cylinder)].name;
}

}  // namespace navvy::vehicle
