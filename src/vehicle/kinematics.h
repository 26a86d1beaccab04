// SPDX-License-Identifier: Apache-2.0
// Forward kinematics and cylinder geometry of a machine's tree, without any engine.
#pragma once

#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Poses of all links for base pose X_WB (pose of links[0]) and joint positions.
std::vector<Pose> forward_kinematics(const scene::Machine& machine, const Pose& X_WB, const std::vector<double>& q);

/// Cylinder length [m] and lever arm dl/dq [m/rad] at joint position q.
struct CylinderGeometry {
  double length = 0, lever = 0;
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();  ///< pins in base_link's frame [m]
};
CylinderGeometry cylinder_geometry(const scene::Machine& machine, const scene::Cylinder& cylinder, double q);

/// Largest torques [N m] (positive and negative direction of the joint) and speeds [rad/s] that the cylinder allows at q.
struct CylinderLimits {
  double torque_positive = 0, torque_negative = 0, speed_positive = 0, speed_negative = 0;
};
CylinderLimits cylinder_limits(const scene::Machine& machine, const scene::Cylinder& cylinder, double q);

}  // namespace navvy::vehicle
