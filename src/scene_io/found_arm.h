// SPDX-License-Identifier: Apache-2.0
// Finds the arm of an excavator in a machine whose file does not name its joints' roles.
#pragma once

#include <optional>

#include "scene/machine.h"

namespace navvy::scene_io {

/// Indices of the joints of an arm in scene::Machine::joints.
struct FoundArm {
  int swing = -1, boom = -1, stick = -1, bucket = -1;  ///< swing: -1 if there is none
  Vec3 forward = Vec3::UnitX();  ///< horizontal direction of the arm in the machine's frame
};

/// Returns the arm of a machine: three revolute joints in a row, across fixed joints, about level
/// and parallel axes, below one about the vertical if there is one. Of several such rows, one whose
/// last joint or link is called bucket, shovel or dipper is taken, then one that moves nothing
/// more, then the one that reaches furthest.
std::optional<FoundArm> find_arm(const scene::Machine& machine);

}  // namespace navvy::scene_io
