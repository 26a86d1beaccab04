// SPDX-License-Identifier: Apache-2.0
// Initial poses of machines, for checks of a scene without running it.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/cell_rect.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::sim {

/// Returns X_WB of every machine's base link at the start, in the scene's order, as a World of this
/// scene and ground has them. Needs no device.
std::vector<Pose> starting_poses(const scene::Scene& scene, const heightfield::Ground& ground);

/// Returns the columns of a box of active soil, rounded to whole columns and clipped at the site's
/// edge.
heightfield::CellRect active_columns(const scene::ActiveSoil& active,
                                     const heightfield::Ground& ground);

/// Checks that the initially active soil fits into the scene's particle budget, before memory is
/// allocated. Reads at most as many columns as the budget has particles. @throws InputError naming
/// the box.
void check_active(const scene::Scene& scene, const heightfield::Ground& ground);

}  // namespace navvy::sim
