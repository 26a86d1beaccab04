// SPDX-License-Identifier: Apache-2.0
// Lines that pictures of a map show over it.
#pragma once

#include <vector>

#include "core/math.h"

namespace navvy::map {

/// A line over a map, such as a planned path.
struct MapLine {
  /// Number of the line, from 1; pictures choose the colour by it.
  int number = 1;
  /// Corners in W [m].
  std::vector<Vec2> places;
};

}  // namespace navvy::map
