// SPDX-License-Identifier: Apache-2.0
// Finds the wheels of a machine whose file does not say which links are wheels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/machine.h"

namespace navvy::scene_io {

/// A link that rolls: round about the axis of a joint without end, and low enough to touch the
/// ground.
struct FoundWheel {
  int joint = -1;                ///< index of the joint that spins it
  int steer = -1;                ///< index of the joint that steers it; -1: none
  int swivel = -1;               ///< index of a joint without end that turns its carrier; -1: none
  bool caster = false;           ///< true: it swivels freely, so that nothing drives or steers it
  bool points_right = false;     ///< true: its axis points to the right, -y of the machine
  Vec3 p_MW = Vec3::Zero();      ///< its middle in the machine's frame [m]
  double radius = 0, width = 0;  ///< its size [m]
  double friction = 0.8;         ///< coefficient of friction of its shape [-]
};

/// Returns the wheels of a machine, in the order of its joints. A wheel is a link on a revolute
/// joint without limits whose axis is level within 6 degrees; a cylinder along that axis, a sphere,
/// or a mesh that is round about it within 5 %, gives radius and width; its lowest point is within
/// 0.3 radii of that of the lowest wheel. A wheel beside a steered one is steered as well, even if
/// its joint has no limits.
std::vector<FoundWheel> find_wheels(const scene::Machine& machine);

}  // namespace navvy::scene_io
