// SPDX-License-Identifier: Apache-2.0
// How a machine stands on the ground it is put on.
#pragma once

#include "core/math.h"
#include "heightfield/ground.h"
#include "scene/scene.h"

namespace navvy::coupling {

/// Pose of the machine's base link at the start. On level ground, or without wheels, the pose of the scene with z
/// counted from the ground below. On a slope a machine on wheels is tilted with the plane through the ground under its
/// tyres and raised until none of them is in the ground: a level machine would press its uphill wheels into it. Height,
/// roll and pitch of the scene come on top of that.
Pose place(const scene::MachineInWorld& placed, const heightfield::Ground& ground);

}  // namespace navvy::coupling
