// SPDX-License-Identifier: Apache-2.0
// Queries compared with closed forms; the same queries from four threads while the map's maker
// continues.
#include "map/map_queries.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <ctime>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "map/cut_and_fill.h"
#include "map/grounds.h"
#include "planner/footprint.h"

namespace navvy::map {
namespace {

using planner::clearance;
using planner::Footprint;

using testing::centre;
using testing::map_of;
using testing::setup;

double plane(double x, double y) { return 0.5 + 0.3 * x - 0.2 * y; }

TEST(Queries, AreExactOnAPlane) {
  const TerrainMap map = map_of(setup(), plane);
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    // Inside the outermost half columns, which are level.
    const double x = random.uniform(-3.2, 11.4), y = random.uniform(1.8, 9.9);
    EXPECT_NEAR(height(map, x, y), plane(x, y), 3e-7);  // a float's ulp at 4 m
    EXPECT_NEAR((*normal(map, x, y) - Vec3(-0.3, 0.2, 1).normalized()).norm(), 0, 5e-6);
    EXPECT_NEAR(slope(map, x, y), std::atan(std::hypot(0.3, 0.2)), 5e-6);
  }
  const Vec2 c = centre(map.setup(), 147, 83);
  EXPECT_NEAR(height(map, c.x(), c.y()), static_cast<double>(map.at(MapLayer::kElevation, 147, 83)),
              1e-12);
  EXPECT_EQ(value(map, MapLayer::kElevation, 11.5, 10.1), map.at(MapLayer::kElevation, 147, 83));
  EXPECT_EQ(value(map, MapLayer::kElevation, -3.3, 1.7), map.at(MapLayer::kElevation, 0, 0));
}

TEST(Queries, AreUnknownOutsideTheSiteAndBesideUnknownColumns) {
  TerrainMap map = map_of(setup(), plane);
  std::vector<float> z = map.copy(MapLayer::kElevation);
  z[static_cast<std::size_t>(40 * 148 + 60)] = kUnknown;
  map = map.with(MapLayer::kElevation, z);
  const Vec2 hole = centre(map.setup(), 60, 40);
  for (const Vec2& p : {Vec2(-3.31, 5), Vec2(11.51, 5), Vec2(0, 1.69), Vec2(0, 10.11), Vec2(NAN, 3),
                        hole, Vec2(hole + Vec2(0.09, 0))}) {
    EXPECT_TRUE(std::isnan(height(map, p.x(), p.y())));
    EXPECT_TRUE(std::isnan(slope(map, p.x(), p.y())));
    EXPECT_FALSE(normal(map, p.x(), p.y()).has_value());
  }
  EXPECT_TRUE(std::isnan(value(map, MapLayer::kElevation, hole.x(), hole.y())));
  // At its neighbour's centre the height is known.
  EXPECT_FALSE(std::isnan(height(map, hole.x() + 0.1 + 1e-12, hole.y() + 0.1 + 1e-12)));
}

TEST(LineOfSight, IsBlockedByAWallAsGeometryPredicts) {
  // A wall of 2 m at x = 4..4.5; seen from 3 m at x = 0, its shadow on the ground ends 1.5 m behind
  // its far edge.
  const TerrainMap map =
      map_of(setup(), [](double x, double) { return x > 4 && x < 4.5 ? 2.0 : 0.0; });
  // Its far edge is the centre of the last high column, 4.45 m: from (0, 3) over (4.45, 2) to z =
  // 0.5 at 11.125 m.
  const double reach = 4.45 * (3 - 0.5) / (3 - 2);
  for (const double y : {2.0, 5.03, 9.9}) {
    EXPECT_EQ(line_of_sight(map, Vec3(0, y, 3), Vec3(reach + 1e-3, y, 0.5)), Sight::kFree);
    EXPECT_EQ(line_of_sight(map, Vec3(0, y, 3), Vec3(reach - 1e-3, y, 0.5)), Sight::kHidden);
    EXPECT_EQ(line_of_sight(map, Vec3(reach - 1e-3, y, 0.5), Vec3(0, y, 3)), Sight::kHidden);
  }
  // Obliquely through the wall
  EXPECT_EQ(line_of_sight(map, Vec3(0, 3, 1), Vec3(8, 9, 1)), Sight::kHidden);
  EXPECT_EQ(line_of_sight(map, Vec3(0, 3, 2.01), Vec3(8, 9, 2.01)), Sight::kFree);
  EXPECT_EQ(line_of_sight(map, Vec3(2, 3, 5), Vec3(2, 3, 0.01)), Sight::kFree);  // straight down
  EXPECT_EQ(line_of_sight(map, Vec3(2, 3, 5), Vec3(2, 3, -0.01)), Sight::kHidden);
  EXPECT_EQ(line_of_sight(map, Vec3(0, 3, 5), Vec3(40, 3, 5)), Sight::kUnsure);  // leaves the site
  EXPECT_EQ(line_of_sight(map, Vec3(-20, 3, 1), Vec3(20, 3, 1)), Sight::kHidden);
  EXPECT_EQ(line_of_sight(map, Vec3(0, 30, 1), Vec3(9, 30, 1)), Sight::kUnsure);
}

TEST(LineOfSight, AgreesWithFineSamplingOnRollingGround) {
  const TerrainMap map = map_of(setup(), [](double x, double y) {
    return 0.5 * std::sin(1.3 * x) + 0.4 * std::cos(1.7 * y);
  });
  Random random(11);
  int hidden = 0, judged = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 p(random.uniform(-3, 11), random.uniform(2, 10), random.uniform(-0.5, 1.2));
    const Vec3 q(random.uniform(-3, 11), random.uniform(2, 10), random.uniform(-0.5, 1.2));
    double low = 1e9;
    for (int k = 0; k <= 2000; ++k) {
      const Vec3 r = p + (q - p) * (k / 2000.0);
      low = std::min(low, r.z() - height(map, r.x(), r.y()));
    }
    if (std::abs(low) < 1e-3) continue;  // between samples 7 mm apart it may touch
    ++judged;
    hidden += low < 0;
    EXPECT_EQ(line_of_sight(map, p, q), low < 0 ? Sight::kHidden : Sight::kFree) << i << " " << low;
  }
  EXPECT_GT(judged, 350);
  EXPECT_GT(hidden, 50);
  EXPECT_GT(judged - hidden, 50);
}

TEST(Queries, AreTheSameInFourThreadsWhileTheMakerUpdates) {
  heightfield::GroundSetup s = setup();
  s.surface = [](int ix, int iy) { return 0.3 * std::sin(0.11 * ix) + 0.2 * std::cos(0.07 * iy); };
  heightfield::Ground ground(s);
  MapMaker maker({});
  maker.update(ground.view());
  const TerrainMap map = maker.map();
  const auto sum = [&] {
    Random random(4);
    double all = 0;
    for (int i = 0; i < 3000; ++i) {
      const double x = random.uniform(-3, 11), y = random.uniform(2, 10);
      all += height(map, x, y) + slope(map, x, y) +
             static_cast<double>(value(map, MapLayer::kRoughness, x, y));
      if (i % 30 == 0)
        all += clearance(map, {1, 1, 0.5, 0.5}, x, y, x) +
               cut_and_fill(map, std::vector{Vec2(0, 3), Vec2(x, 9), Vec2(-2, y)}).fill;
    }
    return all;
  };
  const double expected = sum();
  std::atomic<int> wrong{0}, running{4};
  std::vector<std::thread> readers;
  readers.reserve(4);
  for (int t = 0; t < 4; ++t)
    readers.emplace_back([&] {
      for (int k = 0; k < 5; ++k) wrong += sum() == expected ? 0 : 1;
      --running;
    });
  std::vector<heightfield::SoilLayer> taken;
  for (int k = 0; running > 0; ++k) {
    for (int i = 0; i < 30; ++i)
      ground.take_above((7 * k + i) % 148, (11 * k) % 84, -0.5 - 0.001 * k, taken);
    maker.update(ground.view(k));
    const TerrainMap other = maker.map();
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Queries, ReportTheirRates) {
  const TerrainMap map = map_of(setup(), [](double x, double y) {
    return 0.3 * std::sin(1.3 * x) + 0.2 * std::cos(1.7 * y);
  });
  double sum = 0;
  Random random(9);
  // Processor time, as other processes may hold the machine.
  std::clock_t begin = std::clock();
  const auto spent = [&] {
    const std::clock_t now = std::clock();
    return static_cast<double>(now - std::exchange(begin, now)) / CLOCKS_PER_SEC;
  };
  constexpr int kHeights = 1000000, kClearances = 20000;
  for (int i = 0; i < kHeights; ++i)
    sum += height(map, random.uniform(-3, 11), random.uniform(2, 10));
  const double heights = spent();
  const Footprint excavator{2.5, 2.5, 1.3, 1.3};
  for (int i = 0; i < kClearances; ++i)
    sum += clearance(map, excavator, random.uniform(0, 8), random.uniform(4, 7),
                     random.uniform(-3, 3));
  EXPECT_TRUE(std::isfinite(sum));
  std::printf("%.3g heights and %.3g clearances (5 x 2.6 m, 1 m round it) a second\n",
              kHeights / heights, kClearances / spent());
}

}  // namespace
}  // namespace navvy::map
