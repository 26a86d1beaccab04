// SPDX-License-Identifier: Apache-2.0
// Detects closed meshes. The inner sides of their faces are never visible and need not be drawn.
#pragma once

#include <cstdint>
#include <vector>

#include "render/shading.h"

namespace navvy::render {

/// Returns true if the faces form closed bodies whose outer sides are the front sides: every edge
/// is traversed equally often in both directions, and every connected part of the mesh has a
/// positive volume. Coincident points count as one point. `indices` has Coin's format: the point
/// indices of each face, followed by -1. The cost is O(n log n) for n edges.
bool is_solid(const std::vector<Vec3f>& points, const std::vector<std::int32_t>& indices);

}  // namespace navvy::render
