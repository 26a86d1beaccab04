// SPDX-License-Identifier: Apache-2.0
// Initial pose of a machine on the ground.
#pragma once

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::coupling {

/// Returns X_WM, the pose of the model frame at the start. The base link is placed in M by the
/// model's file.
///
/// With `on_ground` false this is the scene's pose. Otherwise z counts from the ground below the
/// frame's origin, and a machine on three or more wheels is tilted with the plane through the
/// ground under its tyres and raised until no tyre is in the ground: a level machine would press
/// its uphill wheels into it. On a plane its x and y axes are then parallel to the plane. Height,
/// roll and pitch of the scene are added on top.
Pose place(const scene::MachineInWorld& placed, const heightfield::Ground& ground);

/// Returns X_WB of the base link of a machine whose model frame is at X_WM, at any joint positions.
Pose base_pose(const scene::Machine& machine, const Pose& X_WM);

}  // namespace navvy::coupling
