// SPDX-License-Identifier: Apache-2.0
// The terrain of a world at this instant.
#pragma once

#include "heightfield/terrain_view.h"
#include "sim/world.h"

namespace navvy::sim {

/// A copy of the world's terrain that never changes, stamped with its time. Pictures, maps, files, operators and
/// planners read this and name the surface that they mean.
///
/// The columns alone cost what was changed since the last view, microseconds; loose soil costs a pass over the
/// particles.
heightfield::TerrainView terrain_view(const World& world, heightfield::SurfaceKind surface);

}  // namespace navvy::sim
