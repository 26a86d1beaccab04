// SPDX-License-Identifier: Apache-2.0
#include "planner/footprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "map/grounds.h"

namespace navvy::planner {
namespace {

using map::MapLayer;
using map::TerrainMap;
using map::testing::map_of;
using map::testing::setup;

// A wall that is not drivable from x = 3.9 (column 72) to 4.2: 0.4 m high, detected in the window
// of two columns.
TerrainMap walled() {
  const TerrainMap map = map_of(setup(), [](double, double) { return 0.0; });
  std::vector<float> good(148 * 84, 1.0f);
  for (int iy = 20; iy < 60; ++iy)
    for (int ix = 72; ix < 75; ++ix) good[static_cast<std::size_t>(iy * 148 + ix)] = 0;
  return map.with(MapLayer::kTraversability, good);
}

TEST(Clearance, IsTheDistanceToTheNearestUndrivableColumn) {
  const TerrainMap map = walled();
  const Footprint body{2, 1, 0.6, 0.4};
  // Its front is at x + 2, the wall's face at 3.9.
  EXPECT_NEAR(clearance(map, body, 1.2, 5.5, 0, 2), 0.7, 1e-9);
  EXPECT_NEAR(clearance(map, body, 1.2, 5.5, 0, 0.5), 0.5, 1e-9) << "limited by the request";
  EXPECT_EQ(clearance(map, body, 2.0, 5.5, 0, 1), 0);
  // Turned round, its rear counts.
  EXPECT_NEAR(clearance(map, body, 2.2, 5.5, kPi, 2), 0.7, 1e-9);
  // Facing +y its right side is next to the wall, facing -y its left one.
  EXPECT_NEAR(clearance(map, body, 3, 5.5, kPi / 2, 2), 0.5, 1e-9);
  EXPECT_NEAR(clearance(map, body, 3, 5.5, -kPi / 2, 2), 0.3, 1e-9);
  // At 45 deg its foremost corner is the front right one: (2 + 0.4) / sqrt 2 ahead in x.
  EXPECT_NEAR(clearance(map, body, 1.5, 5, kPi / 4, 2), 3.9 - 1.5 - 2.4 * std::sqrt(0.5), 1e-9);
  // The wall's end is a corner: at (3.9, 7.7).
  EXPECT_NEAR(clearance(map, {0.1, 0.1, 0.1, 0.1}, 3.5, 8.2, 0, 1), std::hypot(0.3, 0.4), 1e-9);
  // The site ends at y = 10.1; everything beyond is unknown.
  EXPECT_NEAR(clearance(map, {0.1, 0.1, 0.1, 0.1}, 0, 9.8, 0, 1), 0.2, 1e-9);
}

TEST(Clearance, RefusesNegativeAndUndefinedLengths) {
  const TerrainMap map = walled();
  EXPECT_THROW(clearance(map, {-1, 0, 0, 0}, 0, 0, 0), InputError);
  EXPECT_THROW(clearance(map, {1, 1, 1, NAN}, 0, 0, 0), InputError);
  EXPECT_THROW(clearance(map, {1, 1, 1, 1}, NAN, 0, 0), InputError);
  EXPECT_THROW(clearance(map, {1, 1, 1, 1}, 0, 0, 0, 1e9), InputError);
}

}  // namespace
}  // namespace navvy::planner
