// SPDX-License-Identifier: Apache-2.0
#include "heightfield/change_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "core/random.h"
#include "core/saved_state.h"
#include "heightfield/grounds.h"
#include "heightfield/layered_ground.h"

namespace navvy::heightfield {
namespace {

using testing::wavy_setup;
using Columns = std::set<std::pair<int, int>>;

Columns covered(const std::vector<CellRect>& rects) {
  Columns out;
  for (const CellRect& r : rects)
    for (int iy = r.y0; iy < r.y1; ++iy)
      for (int ix = r.x0; ix < r.x1; ++ix) out.insert({ix, iy});
  return out;
}

/// Returns every column with a visible difference, by comparing all of them.
Columns differing(const Terrain& a, const Terrain& b) {
  Columns out;
  for (int iy = 0; iy < a.ny(); ++iy)
    for (int ix = 0; ix < a.nx(); ++ix)
      if (a.height(ix, iy) != b.height(ix, iy) ||
          a.surface_soil(ix, iy) != b.surface_soil(ix, iy) ||
          a.specific_volume(ix, iy) != b.specific_volume(ix, iy) ||
          a.loose_depth(ix, iy) != b.loose_depth(ix, iy))
        out.insert({ix, iy});
  return out;
}

bool holds(const Columns& all, const Columns& part) {
  return std::includes(all.begin(), all.end(), part.begin(), part.end());
}

std::int64_t area(const std::vector<CellRect>& rects) {
  std::int64_t sum = 0;
  for (const CellRect& r : rects) sum += r.area();
  return sum;
}

void edit(Ground& ground, Random& random, int count, const CellRect& where) {
  std::vector<SoilLayer> taken;
  for (int n = 0; n < count; ++n) {
    const int ix = static_cast<int>(random.uniform(where.x0, where.x1));
    const int iy = static_cast<int>(random.uniform(where.y0, where.y1));
    switch (static_cast<int>(random.uniform(0, 3))) {
      case 0:
        ground.take_above(ix, iy, ground.height(ix, iy) - random.uniform(0, 0.2), taken);
        break;
      case 1:
        ground.put(ix, iy, {static_cast<std::uint16_t>(n % 2), 100000, 1.2f, 0.5f});
        break;
      default:
        ground.compact_to(ix, iy, ground.height(ix, iy) - random.uniform(0, 0.02));
    }
  }
}

TEST(ChangeFollower, ReportsTheWholeSiteFirstAndThenNothing) {
  Ground ground(wavy_setup());
  ChangeFollower follower;
  EXPECT_EQ(covered(follower.take(ground.view())).size(), 77u * 45u);
  EXPECT_TRUE(follower.take(ground.view()).empty());
  follower.forget();
  EXPECT_EQ(covered(follower.take(ground.view())).size(), 77u * 45u);
}

TEST(ChangeFollower, ReportsFewChangesExactly) {
  Ground ground(wavy_setup());
  ChangeFollower follower;
  follower.take(ground.view());
  for (const auto& [ix, iy] : Columns{{3, 4}, {4, 4}, {3, 5}, {4, 5}, {70, 40}})
    ground.put(ix, iy, {0, 1000, 1, 0});
  const std::vector<CellRect> rects = follower.take(ground.view());
  EXPECT_EQ(rects.size(), 2u);  // the four neighbours are one rectangle
  EXPECT_EQ(area(rects), 5);
  // A column that was restored is no change, although two edits were announced.
  const double before = ground.height(70, 40);
  std::vector<SoilLayer> taken;
  ground.take_above(70, 40, before - 0.1, taken);
  for (const SoilLayer& layer : taken) ground.put(70, 40, layer);
  ASSERT_EQ(ground.height(70, 40), before);
  EXPECT_TRUE(follower.take(ground.view()).empty());
}

TEST(ChangeFollower, CoversRandomEditsAsAFullComparisonFindsThem) {
  Ground ground(wavy_setup(200, 150));
  Random random(21);
  ChangeFollower often, seldom;
  TerrainView last = ground.view(), long_ago = ground.view();
  often.take(last);
  seldom.take(last);
  for (int round = 0; round < 60; ++round) {
    const int x = static_cast<int>(random.uniform(0, 180)),
              y = static_cast<int>(random.uniform(0, 130));
    // From one column to edits scattered over the whole site.
    const CellRect where = round % 10 == 9 ? ground.site_rect() : CellRect{x, y, x + 20, y + 20};
    edit(ground, random, 1 << (round % 9), where);
    TerrainView view = ground.view();
    if (round % 3 == 0) {
      const double z = view.height(x, y);
      view = view.with(
          LooseSoil(view, {{x, y, z, 0.001, 0, 1.2f}, {x + 7, y + 9, z, 0.001, 0, 1.2f}}));
    }
    const std::vector<CellRect> rects = often.take(view);
    const Columns truth = differing(last, view);
    ASSERT_LE(rects.size(), RectList::kMost);
    ASSERT_TRUE(holds(covered(rects), truth)) << "round " << round;
    if (truth.size() <= RectList::kMost) {
      ASSERT_EQ(covered(rects), truth) << "round " << round;
    }
    last = view;
    if (round % 20 != 19) continue;
    const std::vector<CellRect> many = seldom.take(view);
    ASSERT_LE(many.size(), RectList::kMost);
    ASSERT_TRUE(holds(covered(many), differing(long_ago, view)));
    long_ago = view;
  }
}

TEST(ChangeFollower, IsCorrectAfterASnapshotWasLoaded) {
  Ground ground(wavy_setup());
  Random random(22);
  edit(ground, random, 500, ground.site_rect());
  const std::vector<char> state = saved(ground);
  ChangeFollower follower;
  const TerrainView then = ground.view();
  follower.take(then);
  edit(ground, random, 50, {10, 10, 40, 40});
  const TerrainView later = ground.view();
  follower.take(later);
  load_saved(state, ground);
  // Restored state: columns that the edits changed have changed again, although the sequence number
  // decreased.
  const TerrainView loaded = ground.view();
  EXPECT_TRUE(differing(then, loaded).empty());
  EXPECT_TRUE(holds(covered(follower.take(loaded)), differing(later, loaded)));
  // A different ground counts as another site for the follower, even if it is equal.
  const Ground other(wavy_setup());
  EXPECT_EQ(covered(follower.take(other.view())).size(), 77u * 45u);
}

TEST(RectList, CoversAllAddedRectanglesWithinItsLimit) {
  Random random(23);
  for (int round = 0; round < 30; ++round) {
    RectList list;
    std::vector<CellRect> all;
    for (int n = 0; n < 10 + 20 * round; ++n) {
      const int x = static_cast<int>(random.uniform(0, 300)),
                y = static_cast<int>(random.uniform(0, 200));
      const CellRect rect{x, y, x + static_cast<int>(random.uniform(0, 6)),
                          y + static_cast<int>(random.uniform(0, 6))};
      list.add(rect);
      all.push_back(rect);
    }
    ASSERT_LE(list.rects().size(), RectList::kMost);
    const Columns truth = covered(all);
    ASSERT_TRUE(holds(covered(list.rects()), truth));
    if (all.size() <= RectList::kMost) {
      ASSERT_EQ(covered(list.rects()), truth);
    }
  }
}

TEST(RectList, UnitesThePairThatAddsLeastArea) {
  RectList list;
  // Sixty-three columns far apart, and two that are two cells from each other.
  for (int n = 0; n < 63; ++n) list.add({1000 * n, 500, 1000 * n + 1, 501});
  list.add({0, 0, 1, 1});
  list.add({2, 0, 3, 1});
  EXPECT_EQ(list.rects().size(), 64u);
  EXPECT_EQ(area(list.rects()), 63 + 3);
  EXPECT_EQ(covered(list.rects()).count({1, 0}), 1u);
}

}  // namespace
}  // namespace navvy::heightfield
