// SPDX-License-Identifier: Apache-2.0
// Bodies on a site: outlines, the layer `occupied`, traversability, and updates when bodies move.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "heightfield/occupied_area.h"
#include "map/grounds.h"
#include "map/map_maker.h"

namespace navvy::map {
namespace {

using heightfield::area_around;
using heightfield::Ground;
using heightfield::OccupiedArea;
using heightfield::TerrainView;
using testing::setup;

/// Returns the area of an upright box.
OccupiedArea box(const Vec3& low, const Vec3& high, bool machine = false) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                         (i & 4) != 0 ? high.z() : low.z());
  return area_around(corners, machine);
}

TerrainView with(const Ground& ground, std::vector<OccupiedArea> areas, double time = 0) {
  return ground.view(time).with(
      std::make_shared<const std::vector<OccupiedArea>>(std::move(areas)));
}

MapOptions wanted() {
  MapOptions out;
  out.layers = {MapLayer::kOccupied, MapLayer::kTraversability, MapLayer::kDisturbedAt};
  return out;
}

TerrainMap map_of(const TerrainView& view, const MapOptions& options = wanted()) {
  MapMaker maker(options);
  maker.update(view);
  return maker.map();
}

TEST(OccupiedArea, IsTheConvexHullSeenFromAbove) {
  const OccupiedArea area = area_around(
      {Vec3(0, 0, 1), Vec3(2, 0, 3), Vec3(1, 0.5, 2), Vec3(2, 2, 2), Vec3(0, 2, 2)}, true);
  ASSERT_EQ(area.outline.size(), 4u);
  EXPECT_EQ(area.outline[0], Vec2(0, 0));
  EXPECT_EQ(area.outline[1], Vec2(2, 0));
  EXPECT_EQ(area.outline[2], Vec2(2, 2));
  EXPECT_EQ(area.low, 1);
  EXPECT_EQ(area.high, 3);
  EXPECT_TRUE(area.machine);
}

TEST(OccupiedArea, MeetsARectangleThatItOverlapsAndNoOtherInItsBounds) {
  // A diamond: the corner of its bounding square is free.
  const OccupiedArea diamond =
      area_around({Vec3(1, 0, 0), Vec3(2, 1, 0), Vec3(1, 2, 0), Vec3(0, 1, 0)}, false);
  EXPECT_TRUE(heightfield::meets(diamond, Vec2(0.9, 0.9), Vec2(1.1, 1.1)));
  EXPECT_TRUE(heightfield::meets(diamond, Vec2(-1, -1), Vec2(3, 3)));
  EXPECT_FALSE(heightfield::meets(diamond, Vec2(0, 0), Vec2(0.4, 0.4)));
  EXPECT_FALSE(heightfield::meets(diamond, Vec2(3, 0), Vec2(4, 1)));
}

TEST(OccupiedLayer, HoldsTheHeightOfABodyAndBlocksItsColumns) {
  const Ground ground(setup());
  // Columns 60 to 64 in x and 20 to 29 in y, just within their edges.
  const Vec2 from = ground.origin() + 0.1 * Vec2(60, 20), to = ground.origin() + 0.1 * Vec2(65, 30);
  const TerrainMap map = map_of(with(ground, {box(Vec3(from.x() + 0.01, from.y() + 0.01, -0.1),
                                                  Vec3(to.x() - 0.01, to.y() - 0.01, 1.5))}));
  int occupied = 0;
  for (int iy = 0; iy < map.ny(); ++iy)
    for (int ix = 0; ix < map.nx(); ++ix) {
      const bool inside = ix >= 60 && ix < 65 && iy >= 20 && iy < 30;
      EXPECT_EQ(map.at(MapLayer::kOccupied, ix, iy), inside ? 1.5f : 0.0f) << ix << " " << iy;
      EXPECT_EQ(map.at(MapLayer::kTraversability, ix, iy) > 0, !inside) << ix << " " << iy;
      occupied += inside;
    }
  EXPECT_EQ(occupied, 50);
}

TEST(OccupiedLayer, IgnoresWhatIsLowBuriedOrHighAboveTheGround) {
  const Ground ground(setup());
  const Vec2 at = ground.origin() + Vec2(5, 5);
  const auto of = [&](double low, double high) {
    return map_of(
        with(ground, {box(Vec3(at.x(), at.y(), low), Vec3(at.x() + 1, at.y() + 1, high))}));
  };
  const int ix = 55, iy = 55;
  // A plate that the machine can drive over is in the layer but is no obstacle.
  EXPECT_FLOAT_EQ(of(-0.1, 0.2).at(MapLayer::kOccupied, ix, iy), 0.2f);
  EXPECT_GT(of(-0.1, 0.2).at(MapLayer::kTraversability, ix, iy), 0);
  EXPECT_EQ(of(-2, -0.1).at(MapLayer::kOccupied, ix, iy), 0);
  EXPECT_EQ(of(kHeadroom + 0.1, kHeadroom + 1).at(MapLayer::kOccupied, ix, iy), 0);
  EXPECT_EQ(of(kHeadroom - 0.1, kHeadroom + 1).at(MapLayer::kTraversability, ix, iy), 0);
}

TEST(OccupiedLayer, LeavesMachinesOutWhereTheOptionSaysSo) {
  const Ground ground(setup());
  const Vec2 at = ground.origin() + Vec2(5, 5);
  const TerrainView view =
      with(ground, {box(Vec3(at.x(), at.y(), 0), Vec3(at.x() + 1, at.y() + 1, 2), true)});
  EXPECT_EQ(map_of(view).at(MapLayer::kTraversability, 55, 55), 0);
  MapOptions without = wanted();
  without.machines = false;
  EXPECT_EQ(map_of(view, without).at(MapLayer::kOccupied, 55, 55), 0);
  EXPECT_GT(map_of(view, without).at(MapLayer::kTraversability, 55, 55), 0);
}

TEST(OccupiedLayer, FollowsABodyThatMovesBitForBitAndStampsItsColumns) {
  const Ground ground(setup());
  MapMaker maker(wanted());
  for (int step = 0; step < 6; ++step) {
    const Vec2 at = ground.origin() + Vec2(3 + 0.37 * step, 4 + 0.13 * step);
    // The body leaves the site's map in the last step.
    std::vector<OccupiedArea> areas;
    if (step < 5) areas.push_back(box(Vec3(at.x(), at.y(), 0), Vec3(at.x() + 1, at.y() + 2, 1)));
    const TerrainView view = with(ground, areas, step);
    const std::vector<heightfield::CellRect> rects = maker.update(view);
    EXPECT_FALSE(rects.empty());
    EXPECT_LE(rects.size(), 64u);
    const TerrainMap followed = maker.map(), fresh = map_of(view);
    for (const MapLayer layer : {MapLayer::kOccupied, MapLayer::kTraversability}) {
      const std::vector<float> a = followed.copy(layer), b = fresh.copy(layer);
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << step;
    }
  }
  // Freed in the last update, at 5 s.
  EXPECT_EQ(maker.map().at(MapLayer::kDisturbedAt, 48, 50), 5);
  // No body moves: nothing changes.
  EXPECT_TRUE(maker.update(with(ground, {}, 6)).empty());
}

}  // namespace
}  // namespace navvy::map
