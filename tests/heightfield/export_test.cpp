// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include "core/error.h"
#include "heightfield/file_rows.h"
#include "heightfield/grounds.h"
#include "heightfield/loose_soil.h"
#include "heightfield/make_ground.h"
#include "heightfield/maps.h"
#include "heightfield/terrain_view.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::heightfield {
namespace {

using testing::folder;
using testing::has_tool;
using testing::located;
using testing::wavy_setup;

// Returns an asymmetric ground with a mark in one corner, far from the origin of its map.
Ground marked(double easting, double northing, double offset) {
  Ground::Setup setup = wavy_setup();
  setup.easting = easting;
  setup.northing = northing;
  setup.height_offset = offset;
  Ground ground(std::move(setup));
  std::vector<SoilLayer> taken;
  ground.take_above(70, 3, -1, taken);
  return ground;
}

using Writer = void (*)(const Terrain&, const std::string&);
struct Format {
  const char* name;
  Writer writer;
};
std::vector<Format> formats() {
  std::vector<Format> all;
#ifdef NAVVY_WITH_GDAL
  all.push_back({"map.tif", [](const Terrain& terrain, const std::string& path) {
                   write_geotiff(terrain, path);
                 }});
#endif
  return all;
}

TEST(Export, IsReadByOtherProgramsAtTheRightPlace) {
  if (!has_tool("gdallocationinfo")) GTEST_SKIP() << "gdallocationinfo (gdal-bin) is missing";
  const std::string dir = folder();
  const Ground ground = marked(1540000.25, 5150000.5, 412);
  std::vector<Vec2> points;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix)
      points.push_back(Vec2(1540000.25, 5150000.5) + 0.1 * Vec2(ix + 0.5, iy + 0.5));
  for (const Format& format : formats()) {
    format.writer(ground, dir + format.name);
    const std::vector<double> values = located(dir + format.name, points);
    ASSERT_EQ(values.size(), points.size()) << format.name;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const int nx = ground.nx();
      const double height = ground.height(static_cast<int>(i) % nx, static_cast<int>(i) / nx) + 412;
      // Half an ulp of float at 412 m
      ASSERT_NEAR(values[i], height, 3e-5) << format.name << " " << i;
    }
    EXPECT_FALSE(std::filesystem::exists(dir + format.name + ".part"));
  }
}

#ifdef NAVVY_WITH_GDAL
TEST(Export, ReimportsTheSameGroundAtAnEastingOfAMillionAndAHalf) {
  const std::string dir = folder();
  const auto z = [](int c, int r) {
    return std::to_string(870 + 0.375 * c - 0.25 * r + 0.0625 * ((c * r) % 5));
  };
  const std::string header = "xllcorner 1540000.37\nyllcorner 5150000.81\ncellsize 1\n";
  testing::write_text(dir + "source.asc", testing::ascii_grid(30, 20, header, z));
  const Ground first = make_ground(testing::map_world(dir + "source.asc", 0.25, Vec2(20, 12)));
  for (const Format& format : formats()) {
    format.writer(first, dir + format.name);
    std::string report;
    const Ground second =
        make_ground(testing::map_world(dir + format.name, 0.25, Vec2(20, 12)), &report);
    // 1e-6 m: coordinates are doubles; in float they would be off by 0.125 m.
    EXPECT_NEAR(second.setup().easting, first.setup().easting, 1e-6) << report;
    EXPECT_NEAR(second.setup().northing, first.setup().northing, 1e-6);
    for (int iy = 0; iy < first.ny(); ++iy)
      for (int ix = 0; ix < first.nx(); ++ix)
        // Half an ulp of float at 870 m, and interpolation between columns that are 1e-9 m off.
        ASSERT_NEAR(second.height(ix, iy) + second.setup().height_offset,
                    first.height(ix, iy) + first.setup().height_offset, 6e-5);
  }
}

TEST(Export, KeepsTheReferenceAndNodataOfTheSource) {
  if (!has_tool("gdal_translate") || !has_tool("gdalinfo")) GTEST_SKIP() << "gdal-bin is missing";
  const std::string dir = folder();
  const auto z = [](int c, int r) { return std::to_string(10 + 0.5 * c + r); };
  testing::write_text(
      dir + "feet.asc",
      testing::ascii_grid(30, 20, "xllcorner 981000\nyllcorner 195000\ncellsize 1\n", z));
  testing::output_of("gdal_translate -ot Float32 -a_srs EPSG:2263 '" + dir + "feet.asc' '" + dir +
                     "feet.tif'");
  const double foot = 1200.0 / 3937.0;
  const Ground ground =
      make_ground(testing::map_world(dir + "feet.tif", foot, Vec2(20 * foot, 12 * foot)));
  write_geotiff(ground, dir + "out.tif");
  const std::string info = testing::output_of("gdalinfo '" + dir + "out.tif'");
  for (const char* part : {"2263", "NoData Value=-9999", "COMPRESSION=DEFLATE", "PREDICTOR=3",
                           "Type=Float32", "Size is 20, 12"})
    EXPECT_NE(info.find(part), std::string::npos) << part << "\n" << info;
  const std::vector<Vec2> points = {{981005.5, 195004.5}, {981024.5, 195015.5}};
  const std::vector<double> before = located(dir + "feet.tif", points),
                            after = located(dir + "out.tif", points);
  ASSERT_EQ(after.size(), 2u);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(after[i], before[i], 2e-5);
}

TEST(Export, KeepsTheUnitOfHeightsFromAnySource) {
  for (const char* tool : {"gdal_translate", "gdal_edit.py", "gdalinfo"})
    if (!testing::has_tool(tool)) GTEST_SKIP() << tool << " (gdal-bin) is missing";
  const std::string dir = folder();
  const auto z = [](int c, int r) { return std::to_string(2800 + 0.5 * c + 1.25 * r); };
  testing::write_text(
      dir + "map.asc",
      testing::ascii_grid(30, 20, "xllcorner 481000\nyllcorner 195000\ncellsize 1\n", z));
  struct Case {
    const char *crs, *tag, *written;
    double metres, cell;
  };
  const double survey = 1200.0 / 3937.0;
  // Heights in feet over metres, metres over feet, and a vertical CRS in feet (NAVD88, US survey
  // feet).
  for (const Case& one : {Case{"EPSG:26915", "ft", "ft", 0.3048, 1},
                          Case{"EPSG:26915", "US survey foot", "US survey foot", survey, 1},
                          Case{"EPSG:26915", "m", "m", 1, 1}, Case{"EPSG:26915", "", "m", 1, 1},
                          Case{"EPSG:2263", "m", "m", 1, survey},
                          Case{"EPSG:2263", "", "US survey foot", survey, survey},
                          Case{"EPSG:26915+6360", "", "US survey foot", survey, 1}}) {
    const std::string file = dir + "in.tif", out = dir + "out.tif",
                      what = std::string(one.crs) + " " + one.tag;
    testing::output_of(std::string("gdal_translate -ot Float32 -a_srs ") + one.crs + " '" + dir +
                       "map.asc' '" + file + "'");
    if (*one.tag != '\0')
      testing::output_of(std::string("gdal_edit.py -units '") + one.tag + "' '" + file + "'");
    const Vec2 size(20 * one.cell, 12 * one.cell);
    const Ground ground = make_ground(testing::map_world(file, one.cell, size));
    EXPECT_NEAR(ground.setup().file_height_unit, one.metres, 1e-12) << what;
    write_geotiff(ground, out);
    const std::string info = testing::output_of("gdalinfo '" + out + "'");
    EXPECT_NE(info.find(std::string("Unit Type: ") + one.written + "\n"), std::string::npos)
        << what << "\n"
        << info;
    const Ground again = make_ground(testing::map_world(out, one.cell, size));
    EXPECT_NEAR(again.setup().file_height_unit, one.metres, 1e-12) << what;
    for (int iy = 0; iy < ground.ny(); ++iy)
      for (int ix = 0; ix < ground.nx(); ++ix)
        // An ulp of float at 2800 units, and two quanta.
        ASSERT_NEAR(again.height(ix, iy) + again.setup().height_offset,
                    ground.height(ix, iy) + ground.setup().height_offset,
                    2.5e-4 * one.metres + 1e-6)
            << what;
  }
}

TEST(Export, WritesMapLayersAsFurtherBandsThatAnImportIgnores) {
  const std::string dir = folder();
  const Ground ground = marked(100, 200, 0);
  const double top = ground.height(5, 6);
  const TerrainView view = ground.view().with(
      LooseSoil(ground.view(), {{5, 6, top, 0.0015, 0, 1.2f}}), SurfaceKind::kMapped);
  const auto band = [&](const char* name, const auto& value) {
    return MapBand{name, "", [&view, value](int y0, int y1, std::vector<float>& out) {
                     out.clear();
                     for (int iy = y0; iy < y1; ++iy)
                       for (int ix = 0; ix < view.nx(); ++ix) out.push_back(value(ix, iy));
                   }};
  };
  write_geotiff(
      view, dir + "active.tif",
      {band("loose_depth", [&](int ix, int iy) { return view.loose_depth(ix, iy); }),
       band("active", [&](int ix, int iy) { return view.active(ix, iy) ? 1.0f : 0.0f; })});
  write_geotiff(view, dir + "plain.tif");
  std::string report;
  const Ground read =
      make_ground(testing::map_world(dir + "active.tif", 0.1, Vec2(7.7, 4.5)), &report);
  EXPECT_NE(report.find("3 bands"), std::string::npos) << report;
  const Ground plain = make_ground(testing::map_world(dir + "plain.tif", 0.1, Vec2(7.7, 4.5)));
  for (int iy = 0; iy < read.ny(); ++iy)
    for (int ix = 0; ix < read.nx(); ++ix) ASSERT_EQ(read.height(ix, iy), plain.height(ix, iy));
  if (!has_tool("gdallocationinfo") || !has_tool("gdalinfo")) GTEST_SKIP() << "gdal-bin is missing";
  // Returns a point's values, band after band.
  const std::vector<double> values =
      located(dir + "active.tif", {{100.55, 200.65}, {100.75, 200.65}});
  ASSERT_EQ(values.size(), 6u);
  EXPECT_NEAR(values[0], top + 0.15, 1e-6);  // 1.5 l on 0.01 m2; half an ulp of a float at 1 m
  EXPECT_NEAR(values[1], 0.15, 1e-6);
  EXPECT_EQ(values[2], 1);
  EXPECT_NEAR(values[3], ground.height(7, 6), 1e-6);
  EXPECT_EQ(values[4], 0);
  EXPECT_EQ(values[5], 0);
  EXPECT_NE(testing::output_of("gdalinfo '" + dir + "active.tif'").find("loose_depth"),
            std::string::npos);
}
#endif

TEST(Export, LeavesTheOldFileWhenTheDiskIsFull) {
  const std::string dir = folder();
  const Ground ground = marked(0, 0, 0);
  for (const Format& format : formats()) {
    const std::string path = dir + format.name;
    testing::write_text(path, "old");
    rlimit before;
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit little{1000, before.rlim_max};
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &little);
    std::string message;
    try {
      format.writer(ground, path);
    } catch (const FileError& error) {
      message = error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find(path), std::string::npos) << format.name << ": " << message;
    EXPECT_EQ(std::filesystem::file_size(path), 3u);
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
    EXPECT_THROW(format.writer(ground, dir + "no/such/folder/" + format.name), FileError);
  }
}

}  // namespace
}  // namespace navvy::heightfield
