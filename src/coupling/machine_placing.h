// SPDX-License-Identifier: Apache-2.0
// How a machine stands on the ground it is put on.
#pragma once

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::coupling {

/// X_WM of the model frame at the start, which is what an engine is given; the base link stands in
/// it where the model's file says. Off the ground (`on_ground` false) it is the scene's pose. Else
/// z counts from the ground below the frame's origin, and a machine on three wheels or more is
/// tilted with the plane through the ground under its tyres and raised until none of them is in the
/// ground: a level machine would press its uphill wheels into it. On a plane its x and y axes then
/// lie in that plane. Height, roll and pitch of the scene come on top of that.
Pose place(const scene::MachineInWorld& placed, const heightfield::Ground& ground);

/// X_WB of the base link of a machine whose model frame is at X_WM, at any joint positions.
Pose base_pose(const scene::Machine& machine, const Pose& X_WM);

}  // namespace navvy::coupling
