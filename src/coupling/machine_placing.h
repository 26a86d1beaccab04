// SPDX-License-Identifier: Apache-2.0
// Initial poses of machines on the ground.
#pragma once

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::coupling {

/// Returns X_WM, the initial pose of a machine's model frame M in W.
///
/// If `MachineInWorld::on_ground` is false, this is the pose given in the scene. Otherwise the
/// height given in the scene counts from the ground below the origin of M. A machine with three or
/// more wheels is also tilted to the plane fitted to the ground under its wheels, and raised until
/// no wheel is in the ground; otherwise wheels on the uphill side would be pressed into it. The
/// height, roll and pitch given in the scene are then added.
Pose place(const scene::MachineInWorld& placed, const heightfield::Ground& ground);

/// Returns the pose X_WB of the base link in W for a machine whose model frame M has the pose X_WM.
/// It does not depend on the joint positions.
Pose base_pose(const scene::Machine& machine, const Pose& X_WM);

}  // namespace navvy::coupling
