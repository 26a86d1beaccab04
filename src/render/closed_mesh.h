// SPDX-License-Identifier: Apache-2.0
// Tells bodies whose inner sides are never seen.
#pragma once

#include <cstdint>
#include <vector>

#include "render/shading.h"

namespace navvy::render {

/// Whether faces enclose space piece by piece, each piece turned outwards: every edge is walked as
/// often one way as the other and every connected piece has positive volume. Points at one place
/// count as one. `indices` as Coin wants them: point numbers, -1 after each face. Costs the edges,
/// times the logarithm of their number; asked once a body.
bool is_solid(const std::vector<Vec3f>& points, const std::vector<std::int32_t>& indices);

}  // namespace navvy::render
