// SPDX-License-Identifier: Apache-2.0
#include "heightfield/terrain_view.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/hash.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "heightfield/grounds.h"
#include "heightfield/layered_ground.h"

namespace navvy::heightfield {
namespace {

using testing::wavy_setup;

/// Digs and fills `count` random columns of the rectangle; layers that were dug are deposited
/// elsewhere.
void work(Ground& ground, Random& random, int count, const CellRect& where) {
  std::vector<SoilLayer> taken;
  for (int n = 0; n < count; ++n) {
    const int ix = static_cast<int>(random.uniform(where.x0, where.x1));
    const int iy = static_cast<int>(random.uniform(where.y0, where.y1));
    if (n % 2 == 0) {
      ground.take_above(ix, iy, ground.height(ix, iy) - random.uniform(0, 0.3), taken);
    } else if (!taken.empty()) {
      SoilLayer layer = taken.back();
      layer.specific_volume = 1.2f;
      ground.put(ix, iy, layer);
      taken.pop_back();
    }
  }
}

/// Returns a hash of everything readable of a terrain's columns.
std::string reading(const Terrain& terrain) {
  StateHash hash;
  for (int iy = 0; iy < terrain.ny(); ++iy)
    for (int ix = 0; ix < terrain.nx(); ++ix) {
      hash.value(terrain.height(ix, iy));
      hash.value(terrain.start_height(ix, iy));
      hash.value(terrain.surface_soil(ix, iy));
      hash.value(terrain.specific_volume(ix, iy));
      hash.value(terrain.loose_depth(ix, iy));
    }
  return hash.hex();
}

TEST(TerrainView, ReadsTheSameAsTheGround) {
  Ground ground(wavy_setup());
  Random random(1);
  work(ground, random, 3000, ground.site_rect());
  const TerrainView view = ground.view(2.5);
  EXPECT_EQ(view.time(), 2.5);
  EXPECT_EQ(view.sequence(), ground.sequence());
  EXPECT_EQ(view.surface(), SurfaceKind::kColumns);
  EXPECT_EQ(reading(view), reading(ground));
  for (int n = 0; n < 1000; ++n) {
    const double x = random.uniform(-5, 6), y = random.uniform(0, 8);
    ASSERT_EQ(view.sample(x, y), ground.sample(x, y));
    ASSERT_EQ(view.normal(x, y), ground.normal(x, y));
    const Vec3 p(x, y, 3), d = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), -1).normalized();
    ASSERT_EQ(view.ray(p, d, 20), ground.ray(p, d, 20));
  }
}

TEST(TerrainView, IsUnaffectedByChangesOfTheGround) {
  auto ground = std::make_unique<Ground>(wavy_setup());
  Random random(2);
  std::vector<TerrainView> views;
  std::vector<std::string> then;
  for (int n = 0; n < 12; ++n) {
    work(*ground, random, 300, ground->site_rect());
    views.push_back(ground->view(n));
    then.push_back(reading(*ground));
  }
  load_saved(saved(*ground), *ground);
  EXPECT_EQ(reading(*ground), then.back());
  ground.reset();
  for (std::size_t n = 0; n < views.size(); ++n) EXPECT_EQ(reading(views[n]), then[n]) << n;
}

TEST(TerrainView, ShowsSoilAndDensityStateOfTheSurface) {
  Ground ground(wavy_setup());
  std::vector<SoilLayer> taken;
  ground.take_above(20, 20, ground.height(20, 20) - 0.5, taken);  // through 0.3 m of topsoil
  ground.put(21, 20, {0, 1000000, 1.25f, 0.0f});
  ground.take_above(22, 20, -10, taken);  // down to bedrock
  const TerrainView view = ground.view();
  EXPECT_EQ(view.surface_soil(19, 20), 1);
  EXPECT_EQ(view.surface_soil(20, 20), 0);
  EXPECT_EQ(view.surface_soil(21, 20), 0);
  EXPECT_EQ(view.surface_soil(22, 20), 1);  // soil that would be there
  EXPECT_EQ(view.specific_volume(20, 20), 1.0f);
  EXPECT_EQ(view.specific_volume(21, 20), 1.25f);
  EXPECT_EQ(view.specific_volume(22, 20), 1.0f);
  EXPECT_EQ(view.height(22, 20), view.datum());
}

TEST(TerrainView, ShowsLooseSoilOnlyOnRequest) {
  Ground ground(wavy_setup());
  const double top = ground.height(33, 20), below = ground.height(60, 40);
  const std::vector<LooseGrain> grains = {{33, 20, top + 0.05, 0.001, 0, 1.2f},
                                          {33, 20, top + 0.15, 0.001, 1, 1.3f},
                                          {60, 40, below + 1.0, 0.001, 0, 1.2f}};
  const TerrainView columns = ground.view(), seen = columns.with(LooseSoil(columns, grains));
  EXPECT_EQ(seen.surface(), SurfaceKind::kWithLooseSoil);
  EXPECT_EQ(reading(columns), reading(ground));
  // Two litres on 0.01 m2.
  EXPECT_NEAR(seen.height(33, 20), top + 0.2, 1e-12);
  EXPECT_NEAR(seen.loose_depth(33, 20), 0.2, 1e-7);  // float
  EXPECT_TRUE(seen.active(33, 20));
  EXPECT_EQ(seen.surface_soil(33, 20), 1);
  EXPECT_EQ(seen.specific_volume(33, 20), 1.3f);
  EXPECT_FALSE(seen.active(34, 20));
  EXPECT_FALSE(columns.active(33, 20));
  EXPECT_EQ(seen.height(60, 40), below);  // the third is in the air
  EXPECT_FALSE(seen.active(60, 40));
  // Halfway between two centres.
  EXPECT_NEAR(seen.sample(-3.3 + 3.4, 1.7 + 2.05), 0.5 * (top + 0.2 + ground.height(34, 20)),
              1e-12);
  EXPECT_EQ(seen.start_height(33, 20), ground.start_height(33, 20));
}

TEST(LooseSoil, StacksGrainsByVolumeUpToTheFirstGap) {
  const Ground ground(wavy_setup());
  const double top = ground.height(5, 5);
  // Given out of order; each raises the surface by 0.05 m. The grain at 0.26 m is more than two
  // cells above 0.05 m.
  const LooseSoil loose(ground, {{5, 5, top + 0.26, 0.0005, 0, 1},
                                 {5, 5, top, 0.0005, 1, 1},
                                 {99, 5, top, 1, 0, 1},
                                 {4, 6, ground.height(4, 6), 0.0005, 0, 1},
                                 {-1, 5, top, 1, 0, 1}});
  ASSERT_EQ(loose.columns().size(), 2u);
  EXPECT_EQ(loose.columns()[0].ix, 5);
  EXPECT_NEAR(loose.columns()[0].depth, 0.05, 1e-12);
  EXPECT_EQ(loose.columns()[0].soil, 1);
  EXPECT_EQ(loose.columns()[1].iy, 6);
  // A grain in between closes the gap, so that all three rest.
  const LooseSoil closed(ground, {{5, 5, top + 0.26, 0.0005, 0, 1},
                                  {5, 5, top, 0.0005, 1, 1},
                                  {5, 5, top + 0.2, 0.0005, 1, 1}});
  EXPECT_NEAR(closed.columns().at(0).depth, 0.15, 1e-12);
  // It reports which grains rest, so that masses can be assigned to places.
  EXPECT_EQ(closed.grains().size(), 3u);
  ASSERT_EQ(loose.grains().size(), 2u);
  EXPECT_EQ(loose.grains()[0].soil, 1);
  EXPECT_EQ(loose.grains()[1].iy, 6);
  EXPECT_TRUE(LooseSoil(ground, {}).columns().empty());
}

TEST(TerrainView, IsReadBySeveralThreadsWhileTheGroundChanges) {
  // A site of more tiles than the threads could fill before each other.
  Ground ground(wavy_setup(512, 480));
  Random random(5);
  work(ground, random, 2000, {100, 100, 300, 300});
  const TerrainView view = ground.view();
  std::string alone;
  {
    // The same work on a ground without readers.
    Ground other(wavy_setup(512, 480));
    Random same(5);
    work(other, same, 2000, {100, 100, 300, 300});
    alone = reading(other);
  }
  std::atomic<bool> stop{false};
  std::vector<std::string> found(3);
  std::vector<std::thread> readers;
  for (std::string& mine : found) readers.emplace_back([&view, &mine] { mine = reading(view); });
  std::thread writer([&] {
    Random more(6);
    while (!stop) {
      work(ground, more, 50, {0, 0, 512, 480});
      (void)ground.view();
    }
  });
  for (std::thread& reader : readers) reader.join();
  stop = true;
  writer.join();
  for (const std::string& mine : found) EXPECT_EQ(mine, alone);
  EXPECT_EQ(reading(view), alone);
}

TEST(Ground, IsReadBySeveralThreadsAtOnce) {
  Ground ground(wavy_setup(512, 480));
  Random random(7);
  work(ground, random, 2000, {100, 100, 300, 300});
  std::vector<std::string> found(4);
  std::vector<std::thread> readers;
  // Each thread reads untouched tiles that the others fill at the same time, and takes a view in
  // between.
  for (std::string& mine : found)
    readers.emplace_back([&] { mine = reading(ground.view()) + reading(ground); });
  for (std::thread& reader : readers) reader.join();
  const std::string alone = reading(ground) + reading(ground);
  for (const std::string& mine : found) EXPECT_EQ(mine, alone);
}

TEST(Ground, CachesAWideSiteWithinItsLimit) {
  Ground::Setup setup = wavy_setup(6400, 1600);  // 10 000 tiles, 80 MiB of heights
  setup.surface = [](int ix, int iy) { return 0.001 * (ix % 100) + 0.002 * (iy % 50); };
  const SurfaceSource source = setup.surface;
  Ground ground(std::move(setup));
  const std::size_t before = ::mallinfo2().uordblks + ::mallinfo2().hblkhd;
  double most = 0;
  for (int iy = 0; iy < 1600; iy += 16)
    for (int ix = 0; ix < 6400; ix += 16)
      most = std::max(most, std::abs(ground.height(ix, iy) - source(ix, iy)));
  EXPECT_LT(most, 1e-7);  // quantum of mass
  const std::size_t after = ::mallinfo2().uordblks + ::mallinfo2().hblkhd;
  EXPECT_LT(after - before, 20u << 20);  // 2048 tiles of 8 KiB and tables
  // Columns that were not cached are cached again after the next change, once enough of them were
  // requested.
  for (int n = 0; n < 400000; ++n)
    most =
        std::max(most, std::abs(ground.height(6399 - n % 64, 1599) - source(6399 - n % 64, 1599)));
  ground.put(1, 1, {0, 10, 1, 0});
  for (int n = 0; n < 64; ++n)
    most = std::max(most, std::abs(ground.height(6399 - n, 1599) - source(6399 - n, 1599)));
  EXPECT_LT(most, 1e-7);
  EXPECT_LT(::mallinfo2().uordblks + ::mallinfo2().hblkhd - before, 4u << 20);
}

}  // namespace
}  // namespace navvy::heightfield
