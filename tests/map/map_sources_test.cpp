// SPDX-License-Identifier: Apache-2.0
#include "map/map_sources.h"

#include <gtest/gtest.h>

#include <optional>

#include "core/error.h"
#include "folder.h"
#include "heightfield/make_ground.h"
#include "heightfield/maps.h"
#include "map/grounds.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::map {
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
  const heightfield::Ground ground = heightfield::make_ground(scene);
  const TerrainMap map = map_of_site(ground, options_for(scene, ground, all_layers()));
  for (int iy = 0; iy < 48; ++iy)
    for (int ix = 0; ix < 80; ++ix)
      ASSERT_EQ(map.at(MapLayer::kElevation, ix, iy), static_cast<float>(ground.height(ix, iy)));
}

TEST(MapOptionsOfAScene, HaveTheDesignOnlyWhereALayerNeedsIt) {
  scene::Scene scene = pit();
  scene.design.areas.push_back({});
  scene.design.areas.back().polygon = {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)};
  scene.design.areas.back().depth = 0.4;
  const heightfield::Ground ground = heightfield::make_ground(scene);
  EXPECT_TRUE(options_for(scene, ground, {MapLayer::kElevation}).target.empty());
  const MapOptions made = options_for(scene, ground, {MapLayer::kCutFill});
  const heightfield::DesignSurface design = heightfield::make_design(scene, ground).value();
  const MapOptions given = options_for(scene, ground, {MapLayer::kTarget}, &design);
  ASSERT_EQ(made.target.size(), 80u * 48u);
  const auto middle = static_cast<std::size_t>(24 * 80 + 40);
  EXPECT_EQ(made.target[middle], design.at(40, 24));
  EXPECT_EQ(given.target[middle], design.at(40, 24));
  EXPECT_LT(given.target[middle], static_cast<float>(ground.height(40, 24)));
}

#ifdef NAVVY_WITH_GDAL
TEST(MapOfRun, HasTheHeightsOfTheFileAndOfTheStart) {
  const test::Folder folder;
  const scene::Scene scene = pit();
  heightfield::Ground ground = heightfield::make_ground(scene);
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = 30; iy < 40; ++iy)
    for (int ix = 28; ix < 50; ++ix) ground.take_above(ix, iy, -0.9 - 0.01 * ix, taken);
  heightfield::write_geotiff(ground, folder / "terrain_end.tif");
  const heightfield::Ground start = heightfield::make_ground(scene);
  const TerrainMap map = map_of_run(scene, start, folder / "terrain_end.tif", {});
  for (int iy = 0; iy < 48; ++iy)
    for (int ix = 0; ix < 80; ++ix) {
      // A float's ulp at a metre, and a quantum of mass.
      ASSERT_NEAR(map.at(MapLayer::kElevation, ix, iy), ground.height(ix, iy), 2e-7)
          << ix << " " << iy;
      ASSERT_EQ(map.at(MapLayer::kElevationStart, ix, iy),
                static_cast<float>(start.height(ix, iy)));
      const bool dug = iy >= 30 && iy < 40 && ix >= 28 && ix < 50;
      ASSERT_EQ(map.at(MapLayer::kElevation, ix, iy) != map.at(MapLayer::kElevationStart, ix, iy),
                dug)
          << ix << " " << iy;
    }
  EXPECT_TRUE(std::isnan(map.at(MapLayer::kDensity, 3, 3)));
  EXPECT_TRUE(std::isnan(map.time()));
  EXPECT_FALSE(std::isnan(map.at(MapLayer::kTraversability, 3, 3)));
}

TEST(MapOfRun, ReportsLooseAndActiveSoil) {
  const test::Folder folder;
  const scene::Scene scene = pit();
  const heightfield::Ground start = heightfield::make_ground(scene);
  const heightfield::TerrainView columns = start.view(2);
  // Beyond the first tile of a map, and more than one grain on a column.
  const heightfield::TerrainView view = columns.with(
      heightfield::LooseSoil(columns, {{70, 41, start.height(70, 41) + 0.02, 1e-4, 0, 1.2f, 0},
                                       {70, 41, start.height(70, 41) + 0.03, 1e-4, 0, 1.2f, 0},
                                       {3, 2, start.height(3, 2) + 0.02, 1e-4, 1, 1.1f, 0}}),
      heightfield::SurfaceKind::kMapped);
  heightfield::write_geotiff(
      view, folder / "terrain_end.tif",
      {{"loose_depth", "m", [&](int y0, int y1, std::vector<float>& out) {
          out = layer_values(view, MapLayer::kLooseDepth, {0, y0, view.nx(), y1});
        }}});
  const TerrainMap map = map_of_run(scene, start, folder / "terrain_end.tif", {});
  int lying = 0;
  for (int iy = 0; iy < 48; ++iy)
    for (int ix = 0; ix < 80; ++ix) {
      ASSERT_EQ(map.at(MapLayer::kLooseDepth, ix, iy), view.loose_depth(ix, iy)) << ix << " " << iy;
      ASSERT_EQ(map.at(MapLayer::kActive, ix, iy), view.active(ix, iy) ? 1.0f : 0.0f)
          << ix << " " << iy;
      lying += view.active(ix, iy) ? 1 : 0;
    }
  EXPECT_EQ(lying, 2);
  // If all soil is at rest, a run writes heights only: there is no loose soil.
  heightfield::write_geotiff(start, folder / "rest.tif");
  const TerrainMap rest = map_of_run(scene, start, folder / "rest.tif", {});
  EXPECT_EQ(rest.at(MapLayer::kLooseDepth, 70, 41), 0.0f);
  EXPECT_EQ(rest.at(MapLayer::kActive, 3, 2), 0.0f);
  EXPECT_TRUE(std::isnan(rest.at(MapLayer::kDisturbedAt, 3, 2)));
}

TEST(MapOfRun, OutlivesItsSources) {
  const test::Folder folder;
  const scene::Scene scene = pit();
  std::optional<heightfield::Ground> ground = heightfield::make_ground(scene);
  std::vector<heightfield::SoilLayer> taken;
  ground->take_above(33, 44, -2, taken);
  const double dug = ground->height(33, 44);
  heightfield::write_geotiff(*ground, folder / "terrain_end.tif");
  ground = heightfield::make_ground(scene);
  const double whole = ground->height(33, 44);
  const TerrainMap map = map_of_run(scene, *ground, folder / "terrain_end.tif", {});
  ground.reset();
  // A float's ulp at a metre, and a quantum of mass.
  EXPECT_NEAR(map.at(MapLayer::kElevation, 33, 44), dug, 2e-7);
  EXPECT_EQ(map.at(MapLayer::kElevationStart, 33, 44), static_cast<float>(whole));
}

TEST(MapOfRun, ReadsHeightsInFeet) {
  for (const char* tool : {"gdal_translate", "gdal_edit.py"})
    if (!heightfield::testing::has_tool(tool)) GTEST_SKIP() << tool << " (gdal-bin) is missing";
  const std::string dir = heightfield::testing::folder();
  const auto z = [](int c, int r) { return std::to_string(900 + 0.5 * c + 0.25 * r); };
  heightfield::testing::write_text(
      dir + "map.asc",
      heightfield::testing::ascii_grid(30, 20, "xllcorner 0\nyllcorner 0\ncellsize 1\n", z));
  heightfield::testing::output_of("gdal_translate -ot Float32 -a_srs EPSG:26915 '" + dir +
                                  "map.asc' '" + dir + "map.tif'");
  heightfield::testing::output_of("gdal_edit.py -units ft '" + dir + "map.tif'");
  const scene::Scene scene = heightfield::testing::map_world(dir + "map.tif", 1, Vec2(20, 12));
  const heightfield::Ground start = heightfield::make_ground(scene);
  heightfield::Ground ground = heightfield::make_ground(scene);
  std::vector<heightfield::SoilLayer> taken;
  ground.take_above(7, 5, ground.height(7, 5) - 0.5, taken);
  heightfield::write_geotiff(ground, dir + "terrain_end.tif");
  const TerrainMap map = map_of_run(scene, start, dir + "terrain_end.tif", {});
  for (int iy = 0; iy < 12; ++iy)
    for (int ix = 0; ix < 20; ++ix)
      // An ulp of float at 900 feet; a quantum of a column of 1 m2 is less.
      ASSERT_NEAR(static_cast<double>(map.at(MapLayer::kElevation, ix, iy)), ground.height(ix, iy),
                  3e-5)
          << ix << " " << iy;
}

TEST(MapOfRun, RefusesAFileThatIsMissingOrOfAnotherSite) {
  const test::Folder folder;
  const heightfield::Ground start = heightfield::make_ground(pit());
  EXPECT_THROW(map_of_run(pit(), start, folder / "none.tif", {}), FileError);
  scene::Scene elsewhere = pit();
  elsewhere.ground.has_origin = true;
  elsewhere.ground.origin = Vec2(100, 200);
  heightfield::write_geotiff(heightfield::make_ground(elsewhere), folder / "other.tif");
  EXPECT_THROW(map_of_run(pit(), start, folder / "other.tif", {}), InputError);
}
#endif

}  // namespace
}  // namespace navvy::map
