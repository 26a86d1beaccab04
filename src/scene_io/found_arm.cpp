// SPDX-License-Identifier: Apache-2.0
#include "scene_io/found_arm.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace navvy::scene_io {

namespace {

const scene::Joint& joint_at(const scene::Machine& machine, int i) {
  return machine.joints[static_cast<std::size_t>(i)];
}

Pose pose_of(const scene::Machine& machine, const scene::Joint& joint) {
  return machine.links[static_cast<std::size_t>(joint.child)].X_ML * joint.X_LcJ;
}

Vec3 axis_of(const scene::Machine& machine, const scene::Joint& joint) {
  return pose_of(machine, joint).linear() * joint.axis;
}

bool is_called_bucket(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.find("bucket") != std::string::npos || name.find("shovel") != std::string::npos ||
         name.find("dipper") != std::string::npos;
}

/// Returns the index of the joint that moves the link, across fixed joints; -1: none.
int joint_above(const scene::Machine& machine, int link) {
  // The child of joint i is link i + 1.
  while (link > 0 && joint_at(machine, link - 1).type == scene::Joint::Type::kFixed)
    link = joint_at(machine, link - 1).parent;
  return link > 0 ? link - 1 : -1;
}

/// Returns the three joints that end with `last`; nothing if they are no arm.
std::optional<FoundArm> arm_ending(const scene::Machine& machine, int last) {
  FoundArm arm;
  arm.bucket = last;
  const auto turns = [&](int j) {
    return j >= 0 && joint_at(machine, j).type == scene::Joint::Type::kRevolute;
  };
  if (!turns(last)) return std::nullopt;
  arm.stick = joint_above(machine, joint_at(machine, last).parent);
  arm.boom = turns(arm.stick) ? joint_above(machine, joint_at(machine, arm.stick).parent) : -1;
  if (!turns(arm.boom)) return std::nullopt;
  const Vec3 axis = axis_of(machine, joint_at(machine, arm.boom));
  if (std::abs(axis.z()) > 0.1) return std::nullopt;
  for (const int j : {arm.stick, arm.bucket})
    if (std::abs(axis_of(machine, joint_at(machine, j)).dot(axis)) < 0.995) return std::nullopt;
  arm.swing = joint_above(machine, joint_at(machine, arm.boom).parent);
  if (!turns(arm.swing) || std::abs(axis_of(machine, joint_at(machine, arm.swing)).z()) < 0.995)
    arm.swing = -1;
  return arm;
}

/// Returns how likely the row is the arm: by name, then by what it moves, then by reach.
double score_of(const scene::Machine& machine, const FoundArm& arm) {
  const scene::Joint& last = joint_at(machine, arm.bucket);
  const Vec3 foot = pose_of(machine, joint_at(machine, arm.boom)).translation();
  double score = (pose_of(machine, last).translation() - foot).norm();
  const std::string& link = machine.links[static_cast<std::size_t>(last.child)].name;
  if (is_called_bucket(last.name) || is_called_bucket(link)) score += 1e6;
  for (const scene::Joint& joint : machine.joints)
    if (joint.parent == last.child && joint.type != scene::Joint::Type::kFixed) score -= 1e3;
  return score;
}

}  // namespace

std::optional<FoundArm> find_arm(const scene::Machine& machine) {
  std::optional<FoundArm> best;
  double most = 0;
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const std::optional<FoundArm> arm = arm_ending(machine, static_cast<int>(j));
    if (!arm) continue;
    const double score = score_of(machine, *arm);
    if (best && score <= most) continue;
    best = arm;
    most = score;
  }
  if (!best) return best;
  const auto pin = [&](int j) -> Vec3 {
    return pose_of(machine, joint_at(machine, j)).translation();
  };
  best->forward = axis_of(machine, joint_at(machine, best->boom)).cross(Vec3::UnitZ()).normalized();
  // An arm that is folded up still has its boom ahead of its foot.
  Vec3 ahead = pin(best->stick) - pin(best->boom);
  if (std::abs(ahead.dot(best->forward)) < 0.1 * ahead.norm())
    ahead = pin(best->bucket) - pin(best->boom);
  if (ahead.dot(best->forward) < 0) best->forward = -best->forward;
  return best;
}

}  // namespace navvy::scene_io
