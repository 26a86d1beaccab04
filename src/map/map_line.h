// SPDX-License-Identifier: Apache-2.0
// Lines that are drawn over pictures of a map.
#pragma once

#include <vector>

#include "core/math.h"

namespace navvy::map {

/// A line over a map, such as a planned path.
struct MapLine {
  /// Number that selects the line's colour in pictures; the first line has number 1.
  int number = 1;
  /// Vertices of the line, as world (x, y) [m].
  std::vector<Vec2> places;
};

}  // namespace navvy::map
