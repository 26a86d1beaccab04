// SPDX-License-Identifier: Apache-2.0
// Where machines stand before anything moves, for those who look at a scene without running it.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/cell_rect.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::sim {

/// X_WB of every machine's base link at the start, in the scene's order: as a World of this scene
/// and ground has them. Needs no device.
std::vector<Pose> starting_poses(const scene::Scene& scene, const heightfield::Ground& ground);

/// The columns of an awake box, rounded to whole ones and cut at the site's edge.
heightfield::CellRect active_columns(const scene::ActiveSoil& active,
                                     const heightfield::Ground& ground);

/// Whether the soil that starts awake fits into the scene's budget of particles, before memory is
/// asked for. Looks at as many columns as the budget has particles at most. @throws InputError
/// naming the box.
void check_active(const scene::Scene& scene, const heightfield::Ground& ground);

}  // namespace navvy::sim
