// SPDX-License-Identifier: Apache-2.0
// Columns inside a polygon.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"

namespace navvy::session {

/// Place and size of a grid of columns in W.
struct ColumnRaster {
  Vec2 origin = Vec2::Zero();  ///< corner with the smallest x and y [m]
  double cell = 1;             ///< side of a column [m]
  int nx = 0, ny = 0;          ///< columns along x and y
};

/// Sets the entries of `marks`, one per column with x running fastest, to 1 whose centre lies
/// inside a simple polygon of world (x, y) corners [m] in either winding. Leaves the others as they
/// are. Goes row by row: the time grows with rows times corners, not with columns times corners.
void mark_inside(const std::vector<Vec2>& polygon, const ColumnRaster& raster,
                 std::vector<std::uint8_t>& marks);

}  // namespace navvy::session
