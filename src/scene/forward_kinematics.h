// SPDX-License-Identifier: Apache-2.0
// Forward kinematics of a machine's links.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::scene {

/// Returns the pose of the joint's child link in its parent link at joint position `q` [rad|m]. A
/// fixed or ball joint ignores `q`. A joint of the base counts from the machine's frame.
Pose joint_pose(const Machine& machine, const Joint& joint, double q);

/// Returns the poses in the world frame of all links of `machine`, in the order of machine.links.
///
/// `X_WB` is the pose of the base link, links[0]. `q` has the position of each joint [rad|m];
/// joints beyond its end are at their initial positions. Ball joints are at their initial rotation.
std::vector<Pose> forward_kinematics(const Machine& machine, const Pose& X_WB,
                                     const std::vector<double>& q);

}  // namespace navvy::scene
