// SPDX-License-Identifier: Apache-2.0
// Where a map is free of what cannot be driven on, told for whole rectangles at once.
#pragma once

#include <cstdint>
#include <vector>

#include "map/terrain_map.h"
#include "planner/footprint.h"

namespace navvy::planner {

/// Counts the columns that are not traversable, in blocks of 4 x 4 and summed over rectangles of
/// blocks from the site's corner. A search asks it for most of its poses: in the open it answers
/// fifty times faster than `clearance`. Making one costs a look at every column, and a byte for
/// each in two.
class ObstacleIndex {
 public:
  explicit ObstacleIndex(const map::TerrainMap& map, float least = 0);

  /// True only where `clearance` would be `range` or more; false may mean either.
  bool surely_clear(const Footprint& footprint, double x, double y, double yaw, double range) const;

 private:
  static constexpr int kBlock = 4;   // columns
  static constexpr int kSlices = 4;  // of a footprint, across its length
  bool empty(const Vec2& low, const Vec2& high) const;

  Vec2 origin_, extent_;
  double side_;  // of a block [m]
  int across_, along_;
  // Blocks with at least one such column in [0, i) x [0, j).
  std::vector<std::uint32_t> sums_;
};

}  // namespace navvy::planner
