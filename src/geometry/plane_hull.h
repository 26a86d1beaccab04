// SPDX-License-Identifier: Apache-2.0
// Convex hulls in a plane.
#pragma once

#include <vector>

#include "core/math.h"

namespace navvy::geometry {

/// Returns the corners of the convex hull of points of a plane, counter-clockwise; points on its
/// edges are left out.
std::vector<Vec2> plane_hull(std::vector<Vec2> points);

}  // namespace navvy::geometry
