// SPDX-License-Identifier: Apache-2.0
#include "scene/forward_kinematics.h"

namespace navvy::scene {
namespace {

Pose motion_of(const Joint& joint, double q) {
  Pose X = Pose::Identity();
  if (joint.type == Joint::Type::kRevolute)
    X.linear() = Eigen::AngleAxisd(q, joint.axis.normalized()).toRotationMatrix();
  if (joint.type == Joint::Type::kPrismatic) X.translation() = q * joint.axis.normalized();
  return X;
}

}  // namespace

Pose joint_pose(const Machine& machine, const Joint& joint, double q) {
  // Child in parent at 0, then the motion in the joint's own frame, which is fixed in the child.
  const Pose X_MC = machine.links[static_cast<std::size_t>(joint.child)].X_ML;
  const Pose X_PC0 =
      joint.parent < 0
          ? X_MC
          : machine.links[static_cast<std::size_t>(joint.parent)].X_ML.inverse() * X_MC;
  return X_PC0 * joint.X_LcJ * motion_of(joint, q) * joint.X_LcJ.inverse();
}

// Each link follows from its parent's pose.
std::vector<Pose> forward_kinematics(const Machine& machine, const Pose& X_WB,
                                     const std::vector<double>& q) {
  std::vector<Pose> poses(machine.links.size(), X_WB);
  std::vector<char> placed(machine.links.size(), 0);
  if (poses.empty()) return poses;
  placed[0] = 1;
  // Joints may be listed in any order: repeat until no link follows a placed one (one pass for an
  // ordered tree).
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t j = 0; j < machine.joints.size(); ++j) {
      const Joint& joint = machine.joints[j];
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

}  // namespace navvy::scene
