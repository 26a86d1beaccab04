// SPDX-License-Identifier: Apache-2.0
// Where machines stand before anything moves, for those who look at a scene without running it.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/ground.h"
#include "scene/scene.h"

namespace navvy::sim {

/// X_WB of every machine's base link at the start, in the scene's order: as a World of this scene and ground has them.
/// Needs no device.
std::vector<Pose> starting_poses(const scene::Scene& scene, const heightfield::Ground& ground);

}  // namespace navvy::sim
