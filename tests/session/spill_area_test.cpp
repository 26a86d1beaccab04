// SPDX-License-Identifier: Apache-2.0
// Columns inside the areas in which soil may come to rest.
#include "session/spill_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace navvy::session {
namespace {

/// Counts the edges that a ray from `p` along x crosses.
bool is_inside(const std::vector<Vec2>& polygon, const Vec2& p) {
  bool inside = false;
  for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
    const Vec2 &a = polygon[i], &b = polygon[k];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

/// Returns a star of `corners` corners around `centre`, which reach 3 and 7 m from it.
std::vector<Vec2> star(const Vec2& centre, int corners) {
  std::vector<Vec2> out;
  for (int i = 0; i < corners; ++i) {
    const double angle = radians(360) * i / corners + 0.1, reach = i % 2 == 0 ? 7 : 3;
    out.emplace_back(centre + reach * Vec2(std::cos(angle), std::sin(angle)));
  }
  return out;
}

TEST(SpillArea, MarksTheColumnsWhoseCentresLieInside) {
  const ColumnRaster raster{Vec2(-6.03, -4.51), 0.2, 63, 47};
  for (const int corners : {4, 10, 26}) {
    // The first lies within the site, the second beyond two of its borders, the third far away.
    for (const Vec2& centre : {Vec2(0.2, 0.1), Vec2(7, 5), Vec2(1e6, -1e6)}) {
      std::vector<Vec2> polygon = star(centre, corners);
      for (int winding = 0; winding < 2; ++winding) {
        std::vector<std::uint8_t> marks(63u * 47u, 0);
        mark_inside(polygon, raster, marks);
        for (std::size_t k = 0; k < marks.size(); ++k) {
          const std::size_t x = k % 63, y = k / 63;
          const Vec2 p = raster.origin + raster.cell * Vec2(double(x) + 0.5, double(y) + 0.5);
          ASSERT_EQ(marks[k] != 0, is_inside(polygon, p)) << corners << " corners, column " << k;
        }
        std::reverse(polygon.begin(), polygon.end());
      }
    }
  }
}

TEST(SpillArea, KeepsTheMarksOfOtherAreas) {
  std::vector<std::uint8_t> marks(16, 0);
  marks[0] = 1;
  mark_inside({{2, 2}, {4, 2}, {4, 4}, {2, 4}}, {Vec2(0, 0), 1, 4, 4}, marks);
  EXPECT_EQ(marks, (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 1}));
}

}  // namespace
}  // namespace navvy::session
