// SPDX-License-Identifier: Apache-2.0
// Cut and fill compared with closed forms of prism, frustum and cone.
#include "map/cut_and_fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "map/grounds.h"

namespace navvy::map {
namespace {

using testing::map_of;
using testing::setup;

/// Within 0.5 %: columns of 0.1 m under bodies of metres.
void expect_volume(const char* name, double measured, double exact) {
  std::printf("%s: %.5f m3, off by %.4f %%\n", name, measured, 100 * (measured / exact - 1));
  EXPECT_NEAR(measured, exact, 0.005 * exact) << name;
}

std::vector<Vec2> box(double x0, double y0, double x1, double y1) {
  return {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)};
}
const std::vector<Vec2> kSite = box(-3.3, 1.7, 11.5, 10.1);

TEST(CutAndFill, MatchesThePrismOfATrench) {
  const TerrainMap map = map_of(setup(), [](double x, double y) {
    return x > -1.0 && x < 5.0 && y > 4.0 && y < 5.2 ? -1.5 : 0.0;
  });
  const CutFill all = cut_and_fill(map, kSite);
  expect_volume("prism", all.cut, 6.0 * 1.2 * 1.5);
  EXPECT_NEAR(all.fill, 0, 1e-6);  // heights are whole quanta of mass
  EXPECT_NEAR(all.area, 14.8 * 8.4, 1e-9);
  EXPECT_NEAR(all.unknown_area, 0, 1e-9);
  // Half of it, cut by a slanted border through its middle; the opposite winding gives the same.
  std::vector<Vec2> half = {Vec2(2.3, 1.7), Vec2(1.7, 10.1), Vec2(-3.3, 10.1), Vec2(-3.3, 1.7)};
  // Its mean end over y = 4..5.2 is that at 4.6.
  const double share = (2.3 - 0.6 * (4.6 - 1.7) / 8.4 + 1) / 6;
  expect_volume("half a prism", cut_and_fill(map, half).cut, 6.0 * 1.2 * 1.5 * share);
  std::reverse(half.begin(), half.end());
  expect_volume("the same, clockwise", cut_and_fill(map, half).cut, 6.0 * 1.2 * 1.5 * share);
}

TEST(CutAndFill, MatchesTheFrustumOfABatteredPit) {
  // Floor 3 m x 2 m, 1.2 m deep, sides 1 : 1.
  const TerrainMap map = map_of(setup(), [](double x, double y) {
    return std::min(std::max({std::abs(x - 4) - 1.5, std::abs(y - 6) - 1.0, 0.0}) - 1.2, 0.0);
  });
  const double top = (3 + 2.4) * (2 + 2.4), floor = 3 * 2, middle = (3 + 1.2) * (2 + 1.2);
  expect_volume("frustum", cut_and_fill(map, kSite).cut, 1.2 / 6 * (top + floor + 4 * middle));
}

TEST(CutAndFill, MatchesTheConeOfAHeap) {
  const double radius = 2.2, tall = 1.4;
  const TerrainMap map = map_of(setup(), [&](double x, double y) {
    return std::max(0.0, tall * (1 - std::hypot(x - 3.97, y - 5.91) / radius));
  });
  const CutFill all = cut_and_fill(map, kSite);
  expect_volume("cone", all.fill, kPi * radius * radius * tall / 3);
  EXPECT_EQ(all.cut, 0);
  EXPECT_NEAR(all.fill_bank, all.fill, 1e-6 * all.fill) << "the map's soil is as dense as bank";
  EXPECT_EQ(all.active, 0);
  // A sector of an eighth.
  const std::vector<Vec2> eighth = {Vec2(3.97, 5.91), Vec2(3.97 + 4, 5.91),
                                    Vec2(3.97 + 4, 5.91 + 4)};
  expect_volume("an eighth of a cone", cut_and_fill(map, eighth).fill,
                kPi * radius * radius * tall / 24);
}

TEST(CutAndFill, SeparatesBankAndActiveSoil) {
  TerrainMap map = map_of(setup(), [](double, double) { return 0.2; });
  // Topsoil of 1100 swollen by 1.25
  map = map.with(MapLayer::kDensity, std::vector<float>(148 * 84, 880.0f));
  map = map.with(MapLayer::kLooseDepth, std::vector<float>(148 * 84, 0.05f));
  const CutFill part = cut_and_fill(map, box(0, 2, 2, 5));
  EXPECT_NEAR(part.fill, 1.2, 1e-6);
  EXPECT_NEAR(part.fill_bank, 0.96, 1e-6);
  EXPECT_NEAR(part.active, 0.3, 1e-6);
}

TEST(CutAndFill, ComparesTheGroundWithTheTarget) {
  heightfield::GroundSetup s = setup();
  MapOptions options;
  options.target.assign(static_cast<std::size_t>(s.nx) * s.ny, kUnknown);
  for (int iy = 10; iy < 20; ++iy)
    for (int ix = 30; ix < 50; ++ix)
      options.target[static_cast<std::size_t>(iy * s.nx + ix)] = -0.75f;
  const TerrainMap map = map_of(
      s, [](double, double) { return 0.25; }, options);
  const CutFill all = cut_and_fill(map, kSite, MapLayer::kTarget);
  EXPECT_NEAR(all.fill, 2.0, 1e-9);  // 2 m x 1 m, 1 m above the design
  EXPECT_EQ(all.cut, 0);
  EXPECT_NEAR(all.area, 2, 1e-9);
  EXPECT_NEAR(all.unknown_area, 14.8 * 8.4 - 2, 1e-9);
}

TEST(CutAndFill, CountsAreaOutsideTheSiteAsUnknown) {
  const TerrainMap map = map_of(setup(), [](double, double) { return -1.0; });
  const CutFill part = cut_and_fill(map, box(10.5, 9.1, 13.5, 11.1));
  EXPECT_NEAR(part.cut, 1, 1e-9);
  EXPECT_NEAR(part.area, 1, 1e-9);
  EXPECT_NEAR(part.unknown_area, 5, 1e-9);
  EXPECT_NEAR(cut_and_fill(map, box(100, 100, 101, 101)).unknown_area, 1, 1e-9);
}

TEST(CutAndFill, RefusesInvalidPolygonsAndReferences) {
  const TerrainMap map = map_of(setup(), [](double, double) { return 0.0; });
  EXPECT_THROW(cut_and_fill(map, std::vector{Vec2(0, 0), Vec2(1, 1)}), InputError);
  EXPECT_THROW(cut_and_fill(map, std::vector{Vec2(0, 0), Vec2(1, 1), Vec2(NAN, 0)}), InputError);
  EXPECT_THROW(cut_and_fill(map, kSite, MapLayer::kSlope), InputError);
}

}  // namespace
}  // namespace navvy::map
