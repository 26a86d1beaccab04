// SPDX-License-Identifier: Apache-2.0
#include "planner/obstacle_index.h"

#include <algorithm>
#include <cmath>

namespace navvy::planner {

ObstacleIndex::ObstacleIndex(const map::TerrainMap& map, float least)
    : origin_(map.origin()),
      extent_(map.cell() * Vec2(map.nx(), map.ny())),
      side_(kBlock * map.cell()),
      across_((map.nx() + kBlock - 1) / kBlock),
      along_((map.ny() + kBlock - 1) / kBlock),
      sums_(static_cast<std::size_t>(across_ + 1) * static_cast<std::size_t>(along_ + 1)) {
  const map::LayerTiles& tiles = map.tiles(map::MapLayer::kTraversability);
  std::vector<std::uint8_t> bad(static_cast<std::size_t>(across_));
  for (int j = 0; j < along_; ++j) {
    // A map without the layer knows no drivable column.
    std::fill(bad.begin(), bad.end(), tiles.empty() ? 1 : 0);
    for (int iy = j * kBlock; iy < std::min((j + 1) * kBlock, map.ny()) && !tiles.empty(); ++iy)
      for (int ix = 0, count = 1; ix < map.nx(); ix += count) {
        const float* row = tiles.row(ix, iy, count);
        count = std::min(count, map.nx() - ix);
        for (int k = 0; k < count; ++k)
          // An unknown value is treated as bad: the comparison is false.
          if (row == nullptr || !(row[k] > least))
            bad[static_cast<std::size_t>((ix + k) / kBlock)] = 1;
      }
    const std::size_t width = static_cast<std::size_t>(across_) + 1;
    std::uint32_t* sums = &sums_[static_cast<std::size_t>(j + 1) * width];
    for (std::size_t i = 1; i < width; ++i) {
      const std::uint32_t left = sums[i - 1], below = *(sums + i - width),
                          corner = *(sums + i - 1 - width);
      sums[i] = left + below - corner + bad[i - 1];
    }
  }
}

// Four sums give the count of a rectangle of blocks. The rectangle is rounded outwards, so the
// answer errs on the safe side.
bool ObstacleIndex::empty(const Vec2& low, const Vec2& high) const {
  // Everything beyond the site is unknown.
  if (!((low - origin_).minCoeff() >= 0) || !((origin_ + extent_ - high).minCoeff() >= 0))
    return false;
  const Vec2i a = ((low - origin_) / side_).cast<int>(), b = ((high - origin_) / side_).cast<int>();
  const int x1 = std::min(b.x() + 1, across_), y1 = std::min(b.y() + 1, along_);
  const auto sum = [&](int i, int j) {
    return sums_[static_cast<std::size_t>(j) * (static_cast<std::size_t>(across_) + 1) +
                 static_cast<std::size_t>(i)];
  };
  return sum(x1, y1) + sum(a.x(), a.y()) == sum(a.x(), y1) + sum(x1, a.y());
}

// A turned footprint is covered by the boxes of its slices: one box around all of it would be too
// large.
bool ObstacleIndex::surely_clear(const Footprint& footprint, double x, double y, double yaw,
                                 double range) const {
  const Vec2 ax(std::cos(yaw), std::sin(yaw)), ay(-ax.y(), ax.x());
  // The footprint, grown by the range on all sides and a little more for rounding, covers every
  // place that is nearer than the range.
  const double grown = range + 1e-6, length = footprint.front + footprint.rear + 2 * grown;
  const Vec2 half(length / (2 * kSlices), (footprint.left + footprint.right) / 2 + grown);
  const Vec2 reach = ax.cwiseAbs() * half.x() + ay.cwiseAbs() * half.y();
  const Vec2 middle = Vec2(x, y) + ay * (footprint.left - footprint.right) / 2;
  for (int i = 0; i < kSlices; ++i) {
    const Vec2 centre = middle + ax * (-footprint.rear - grown + (2 * i + 1) * half.x());
    if (!empty(centre - reach, centre + reach)) return false;
  }
  return true;
}

}  // namespace navvy::planner
