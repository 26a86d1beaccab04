// SPDX-License-Identifier: Apache-2.0
#include "planner/sources.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "folder.h"
#include "heightfield/site.h"
#include "planner/grounds.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::planner {
namespace {

/// A pit and a slope on 80 x 48 columns: more than a tile of the ground.
scene::Scene pit() {
  scene::Scene scene;
  scene.soils = testing::setup().soils;
  scene.ground.layers = {{"topsoil", 0.3}, {"loam", 1}};
  scene.ground.size = Vec2(8, 4.8);
  scene::GroundFeature slope;
  slope.kind = scene::GroundFeature::Kind::kSlope;
  slope.yaw = 0.4;
  slope.angle = 0.07;
  scene.ground.features = {slope};
  return scene;
}

TEST(MapOfSite, IsTheScenesUntouchedGround) {
  const scene::Scene scene = pit();
  const TerrainMap map = map_of_site(scene, {});
  const heightfield::Ground ground = heightfield::make_ground(scene);
  for (int iy = 0; iy < 48; ++iy)
    for (int ix = 0; ix < 80; ++ix)
      ASSERT_EQ(map.at(Layer::kElevation, ix, iy), static_cast<float>(ground.height(ix, iy)));
}

#ifdef NAVVY_WITH_GDAL
TEST(MapOfRun, HasTheHeightsThatTheRunWroteAndThoseOfItsStart) {
  const test::Folder folder;
  const scene::Scene scene = pit();
  heightfield::Ground ground = heightfield::make_ground(scene);
  std::vector<heightfield::Layer> taken;
  for (int iy = 30; iy < 40; ++iy)
    for (int ix = 28; ix < 50; ++ix) ground.take_above(ix, iy, -0.9 - 0.01 * ix, taken);
  heightfield::write_geotiff(ground, folder / "terrain_end.tif");
  const TerrainMap map = map_of_run(scene, folder / "terrain_end.tif", {});
  const heightfield::Ground start = heightfield::make_ground(scene);
  for (int iy = 0; iy < 48; ++iy)
    for (int ix = 0; ix < 80; ++ix) {
      // A float's ulp at a metre, and a quantum of mass.
      ASSERT_NEAR(map.at(Layer::kElevation, ix, iy), ground.height(ix, iy), 2e-7) << ix << " " << iy;
      ASSERT_EQ(map.at(Layer::kElevationStart, ix, iy), static_cast<float>(start.height(ix, iy)));
      const bool dug = iy >= 30 && iy < 40 && ix >= 28 && ix < 50;
      ASSERT_EQ(map.at(Layer::kElevation, ix, iy) != map.at(Layer::kElevationStart, ix, iy), dug) << ix << " " << iy;
    }
  EXPECT_TRUE(std::isnan(map.at(Layer::kDensity, 3, 3)));
  EXPECT_TRUE(std::isnan(map.time()));
  EXPECT_FALSE(std::isnan(map.at(Layer::kTraversability, 3, 3)));
}

TEST(MapOfRun, RefusesAFileThatIsMissingOrOfAnotherSite) {
  const test::Folder folder;
  EXPECT_THROW(map_of_run(pit(), folder / "none.tif", {}), FileError);
  scene::Scene elsewhere = pit();
  elsewhere.ground.has_origin = true;
  elsewhere.ground.origin = Vec2(100, 200);
  heightfield::write_geotiff(heightfield::make_ground(elsewhere), folder / "other.tif");
  EXPECT_THROW(map_of_run(pit(), folder / "other.tif", {}), InputError);
}
#endif

}  // namespace
}  // namespace navvy::planner
