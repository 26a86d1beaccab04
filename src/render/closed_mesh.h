// SPDX-License-Identifier: Apache-2.0
// Detects closed bodies, whose inner sides are never visible.
#pragma once

#include <cstdint>
#include <vector>

#include "render/shading.h"

namespace navvy::render {

/// Returns true when the faces enclose space piece by piece, each piece oriented outwards: every
/// edge is used equally often in both directions, and every connected piece has positive volume.
/// Coincident points count as one. `indices` are in Coin's form: point numbers, -1 after each face.
/// Costs O(n log n) in the number of edges; called once per body.
bool is_solid(const std::vector<Vec3f>& points, const std::vector<std::int32_t>& indices);

}  // namespace navvy::render
