// SPDX-License-Identifier: Apache-2.0
// Initial poses of machines and extent of the initially active soil, to check a scene without
// running it.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/cell_rect.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::sim {

/// Returns X_WB, the initial pose in the world of each machine's base link, one entry per machine
/// in the scene's order. The poses are those that a World of this scene and ground starts with.
/// Needs no device.
std::vector<Pose> starting_poses(const scene::Scene& scene, const heightfield::Ground& ground);

/// Returns the rectangle of ground columns that a box of initially active soil covers. Its borders
/// are rounded to the nearest column borders and clipped at the edge of the site.
heightfield::CellRect active_columns(const scene::ActiveSoil& active,
                                     const heightfield::Ground& ground);

/// Checks that the initially active soil fits into the scene's maximum number of particles, before
/// memory is allocated. Stops at the first column that exceeds the maximum.
/// @throws InputError that names the box of active soil.
void check_active(const scene::Scene& scene, const heightfield::Ground& ground);

}  // namespace navvy::sim
