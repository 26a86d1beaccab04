// SPDX-License-Identifier: Apache-2.0
// Tiles that nobody wrote to are computed on demand, cached or not, and always equal the whole.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "map/grounds.h"
#include "map/terrain_map.h"

namespace navvy::map {
namespace {

using heightfield::CellRect;

float formula(int ix, int iy) {
  return ix % 11 == 3 ? kUnknown : static_cast<float>(0.25 * ix - 0.125 * iy);
}

/// A formula that counts the requested columns.
class Counting final : public LayerSource {
 public:
  void fill(MapLayer /*layer*/, const CellRect& rect, float* out,
            std::size_t stride) const override {
    columns += rect.area();
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix)
        out[static_cast<std::size_t>(iy - rect.y0) * stride +
            static_cast<std::size_t>(ix - rect.x0)] = formula(ix, iy);
  }
  mutable std::atomic<std::int64_t> columns{0};
};

bool same(float a, float b) { return a == b || (a != a && b != b); }

constexpr int kNx = 300, kNy = 170;  // 5 x 3 tiles, the last ones cut

struct Fixture {
  std::shared_ptr<Counting> source = std::make_shared<Counting>();
  LayerTiles tiles{kNx, kNy, MapLayer::kSlope, source};
};

/// Rectangles of any begin and end, some of one row or column, and the whole site.
const CellRect kRects[] = {
    {0, 0, kNx, kNy}, {63, 63, 65, 65}, {5, 100, 299, 101}, {130, 3, 131, 169}, {17, 9, 280, 155}};

void expect_formula(const LayerTiles& tiles, const CellRect& rect, const std::vector<float>& values,
                    int wx, int wy, float written) {
  const float* next = values.data();
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix, ++next) {
      const float expected = ix == wx && iy == wy ? written : formula(ix, iy);
      ASSERT_TRUE(same(*next, expected)) << ix << " " << iy << ": " << *next;
      ASSERT_TRUE(same(tiles.at(ix, iy), expected)) << ix << " " << iy;
    }
}

std::vector<float> copied(const LayerTiles& tiles, const CellRect& rect) {
  std::vector<float> out(static_cast<std::size_t>(rect.area()), -1.0f);
  tiles.copy(rect, out.data(), static_cast<std::size_t>(rect.x1 - rect.x0));
  return out;
}

TEST(LayerTiles, CopiesItsSourceWithoutCachingTiles) {
  for (const CellRect& rect : kRects) {
    const Fixture f;
    EXPECT_EQ(f.source->columns, 0);
    const std::vector<float> values = copied(f.tiles, rect);
    EXPECT_EQ(f.source->columns, rect.area()) << "only the requested columns";
    copied(f.tiles, rect);
    EXPECT_EQ(f.source->columns, 2 * rect.area()) << "not cached";
    expect_formula(f.tiles, rect, values, -1, -1, 0);
  }
}

TEST(LayerTiles, CachesTheTileOfAColumnForAllCopies) {
  const Fixture f;
  const LayerTiles other = f.tiles;
  EXPECT_TRUE(same(f.tiles.at(70, 66), formula(70, 66)));
  EXPECT_EQ(f.source->columns, 64 * 64);
  EXPECT_TRUE(same(other.at(127, 127), formula(127, 127)));
  int count = 0;
  const float* tile = f.tiles.row(64, 64, count);
  EXPECT_EQ(other.row(64, 64, count), tile);
  EXPECT_EQ(count, 64);
  EXPECT_EQ(f.source->columns, 64 * 64) << "requested once";
  LayerTiles::Values buffer;
  EXPECT_EQ(other.passing(1, 1, buffer), tile);
  EXPECT_EQ(other.passing(4, 2, buffer), buffer.data());
  EXPECT_TRUE(same(buffer[static_cast<std::size_t>(20 * 64 + 30)], formula(256 + 30, 128 + 20)));
  EXPECT_TRUE(std::isnan(buffer[static_cast<std::size_t>(20 * 64 + 50)])) << "beyond the site";
}

TEST(LayerTiles, OverridesItsSourceWithoutAffectingCopies) {
  Fixture f;
  f.tiles.at(20, 20);  // a requested tile and another one
  for (const Vec2i& p : {Vec2i(10, 12), Vec2i(140, 77)}) {
    const LayerTiles before = f.tiles;
    EXPECT_FALSE(f.tiles.set(p.x(), p.y(), formula(p.x(), p.y()), 2)) << "already cached";
    EXPECT_TRUE(f.tiles.set(p.x(), p.y(), 1000.0f, 2));
    EXPECT_FALSE(f.tiles.set(p.x(), p.y(), 1000.0f, 3));
    for (const CellRect& rect : kRects) {
      expect_formula(f.tiles, rect, copied(f.tiles, rect), p.x(), p.y(), 1000.0f);
      expect_formula(before, rect, copied(before, rect), -1, -1, 0);
    }
    EXPECT_FALSE(f.tiles.shares(before, p.x() / 64, p.y() / 64));
    EXPECT_TRUE(f.tiles.shares(before, 4, 2));
    f.tiles.set(p.x(), p.y(), formula(p.x(), p.y()), 4);
  }
}

TEST(LayerTiles, WithoutASourceAreUnknownUntilWritten) {
  LayerTiles tiles(kNx, kNy, MapLayer::kTarget, nullptr);
  LayerTiles::Values buffer;
  EXPECT_EQ(tiles.passing(2, 2, buffer), nullptr);
  EXPECT_FALSE(tiles.set(3, 4, kUnknown, 1));
  EXPECT_TRUE(tiles.set(3, 4, 2.5f, 1));
  const std::vector<float> all = copied(tiles, {0, 0, kNx, kNy});
  for (std::size_t i = 0; i < all.size(); ++i)
    ASSERT_EQ(std::isnan(all[i]), i != static_cast<std::size_t>(4 * kNx + 3)) << i;
}

TEST(LayerTiles, CanBeReadBySeveralThreads) {
  const Fixture f;
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 20000; ++i) {
        const int ix = (i * (2 * t + 7)) % kNx, iy = (i * (4 * t + 3)) % kNy;
        if (!same(f.tiles.at(ix, iy), formula(ix, iy))) ++wrong[static_cast<std::size_t>(t)];
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace navvy::map
