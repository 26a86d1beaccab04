// SPDX-License-Identifier: Apache-2.0
// Maps read by windows are bit-identical to maps held in memory.
#include "heightfield/windowed_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/hash.h"
#include "heightfield/grounds.h"
#include "heightfield/make_ground.h"
#include "heightfield/maps.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#include "heightfield/map_files/import.h"
#endif

namespace navvy::heightfield {
namespace {

/// Neither square nor a multiple of any window; cells are not square either. Gaps: one cell, a
/// corner, a row's end, and a block of 11 x 9, which is filled in five rings and spans several
/// windows.
HeightRaster bumpy(bool gaps) {
  HeightRaster out;
  out.nx = 61, out.ny = 47;
  out.cell_x = 0.5, out.cell_y = 0.75;
  out.x0 = -1.3, out.y0 = 2.1;
  for (int iy = 0; iy < out.ny; ++iy)
    for (int ix = 0; ix < out.nx; ++ix)
      out.z.push_back(static_cast<float>(3 * std::sin(0.31 * ix) -
                                         2 * std::cos(0.17 * iy + 0.05 * ix) + 0.001 * iy));
  if (!gaps) return out;
  const float none = std::numeric_limits<float>::quiet_NaN();
  out.at(7, 3) = out.at(0, 0) = out.at(60, 20) = out.at(59, 20) = none;
  for (int iy = 26; iy < 35; ++iy)
    for (int ix = 12; ix < 23; ++ix) out.at(ix, iy) = none;
  return out;
}

std::vector<std::int64_t> gaps_of(const HeightRaster& raster) {
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < raster.z.size(); ++i)
    if (std::isnan(raster.z[i])) out.push_back(static_cast<std::int64_t>(i));
  return out;
}

/// Returns windows of a raster that outlives them; counts the requested cells.
WindowedRaster windows_of(const HeightRaster& raster, int side, std::int64_t* read = nullptr) {
  HeightRaster frame = raster;
  frame.z.clear();
  return WindowedRaster(
      frame,
      [&raster, read](const CellRect& cells, float* out) {
        if (read != nullptr) *read += cells.area();
        for (int iy = cells.y0; iy < cells.y1; ++iy)
          for (int ix = cells.x0; ix < cells.x1; ++ix) *out++ = raster.at(ix, iy);
      },
      side);
}

/// Places on and between cells and beyond the edges; at an edge of 1.2 m several samples are
/// averaged.
void expect_equal(const HeightRaster& whole, const WindowedRaster& windows) {
  for (const double edge : {0.1, 1.2})
    for (double y = 1; y < 39; y += 0.37)
      for (double x = -3; x < 31; x += 0.29)
        ASSERT_EQ(windows.mean(x, y, edge), whole.mean(x, y, edge)) << x << " " << y << " " << edge;
}

TEST(WindowedRaster, IsBitIdenticalToAWholeRasterForAnyWindows) {
  const HeightRaster whole = bumpy(false);
  // Windows of two cells per side are more than are held at a time.
  static_assert(31 * 24 > WindowedRaster::kMostWindows);
  for (const int side : {2, 7, 16, 61, 256}) expect_equal(whole, windows_of(whole, side));
}

TEST(WindowedRaster, FillsGapsLikeAWholeRaster) {
  const HeightRaster broken = bumpy(true);
  HeightRaster whole = broken;
  const GapFill expected = fill_gaps(whole);
  ASSERT_EQ(expected.farthest, 5);
  for (const int side : {2, 7, 256}) {
    WindowedRaster windows = windows_of(broken, side);
    const GapFill filled = windows.fill_gaps(gaps_of(broken));
    EXPECT_EQ(filled.gaps, expected.gaps);
    EXPECT_EQ(filled.farthest, expected.farthest);
    expect_equal(whole, windows);
  }
}

TEST(WindowedRaster, ReportsTheSameCellsAsAWholeRaster) {
  const HeightRaster broken = bumpy(true);
  HeightRaster whole = broken;
  fill_gaps(whole);
  WindowedRaster windows = windows_of(broken, 7);
  windows.fill_gaps(gaps_of(broken));
  const WindowedRaster::Summary report = windows.summary(radians(30));
  const SlopeRange slope = slopes(whole, radians(30));
  EXPECT_EQ(report.slope.least, slope.least);
  EXPECT_EQ(report.slope.most, slope.most);
  EXPECT_EQ(report.slope.share_above, slope.share_above);
  // Width of a bucket of its histogram.
  EXPECT_NEAR(report.slope.median, slope.median, slope.median / 30000);
  const auto [least, most] = std::minmax_element(whole.z.begin(), whole.z.end());
  EXPECT_EQ(report.least, *least);
  EXPECT_EQ(report.most, *most);
  // 61 x 47 numbers: an odd count, whose last four bytes are fed one by one.
  StateHash hash;
  hash.bytes(whole.z.data(), whole.z.size() * sizeof(float));
  for (const double one : {whole.cell_x, whole.cell_y, whole.x0, whole.y0}) hash.value(one);
  hash.value(whole.nx);
  EXPECT_EQ(report.hash, hash.digest());
}

TEST(WindowedRaster, ReadsOnlyTheRequestedWindows) {
  const HeightRaster whole = bumpy(false);
  std::int64_t read = 0;
  const WindowedRaster windows = windows_of(whole, 8, &read);
  EXPECT_EQ(read, 0);
  windows.mean(whole.x0 + 4 * 0.5, whole.y0 + 3 * 0.75, 0.1);
  EXPECT_EQ(read, 81)
      << "one window of 8 x 8 and the row and column that it shares with its neighbours";
  windows.mean(whole.x0 + 5.5 * 0.5, whole.y0 + 2 * 0.75, 0.1);
  EXPECT_EQ(read, 81) << "is held";
}

TEST(WindowedRaster, AnswersSeveralThreadsAtOnce) {
  const HeightRaster whole = bumpy(false);
  const WindowedRaster windows = windows_of(whole, 2);
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 4000; ++i) {
        const double x = -2 + 0.37 * ((i * (t + 3)) % 83), y = 2 + 0.41 * ((i * (2 * t + 5)) % 79);
        if (windows.mean(x, y, 0.1) != whole.mean(x, y, 0.1)) ++wrong[static_cast<std::size_t>(t)];
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

#ifdef NAVVY_WITH_GDAL
/// Expects a site on a map in memory and on the same map by windows to agree in everything visible
/// to a run or to a reader of the report.
void expect_the_same_import(const std::string& file, double cell, const Vec2& size,
                            const std::string& what) {
  const scene::Scene world = testing::map_world(file, cell, size);
  Ground::Setup whole;
  whole.cell = cell;
  whole.nx = site_columns(size.x(), cell), whole.ny = site_columns(size.y(), cell);
  whole.soils = world.soils;
  whole.layers = world.ground.layers;
  const Ground::Setup bare = whole;
  const TerrainReport held = import_terrain(world, whole);
  for (const int side : {5, 16, 256}) {
    Ground::Setup windows = bare;
    const TerrainReport read = import_terrain(world, windows, 0, side);
    EXPECT_EQ(read.text(), held.text()) << what;
    EXPECT_EQ(read.warning(), held.warning()) << what;
    EXPECT_EQ(windows.map_hash, whole.map_hash) << what;
    EXPECT_EQ(windows.datum, whole.datum) << what;
    EXPECT_EQ(windows.height_offset, whole.height_offset) << what;
    for (int iy = 0; iy < whole.ny; ++iy)
      for (int ix = 0; ix < whole.nx; ++ix)
        ASSERT_EQ(windows.surface(ix, iy), whole.surface(ix, iy))
            << what << " " << side << ": " << ix << ", " << iy;
  }
}

TEST(Import, ByWindowsEqualsTheImportOfTheWholeMap) {
  const std::string dir = testing::folder();
  // Rows in the file run southwards; a corner, an edge and the middle have no height, one of them
  // by an undeclared value.
  const auto z = [](int c, int r) -> std::string {
    const bool gap =
        (c < 3 && r > 38) || (c > 18 && c < 29 && r > 12 && r < 19) || (r == 0 && c % 7 == 0);
    return gap                  ? "-9999"
           : c == 40 && r == 30 ? "1e30"
                                : std::to_string(812.34 + 0.7 * std::sin(0.4 * c) + 0.11 * r);
  };
  const std::string text = dir + "map.asc";
  testing::write_text(
      text, testing::ascii_grid(53, 41, "xllcorner 700\nyllcorner 300\ncellsize 0.5\n", z));
  expect_the_same_import(text, 0.2, Vec2(26, 20), "all of a text, finer columns");
  expect_the_same_import(text, 1.3, Vec2(13, 10.4), "part of a text, coarser columns");
  if (!testing::has_tool("gdal_translate")) GTEST_SKIP() << "gdal_translate (gdal-bin) is missing";
  testing::output_of(
      "gdal_translate -ot Float32 -co TILED=YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=32 -co "
      "COMPRESS=DEFLATE '" +
      text + "' '" + dir + "tiled.tif'");
  expect_the_same_import(dir + "tiled.tif", 0.2, Vec2(26, 20), "tiles");
  testing::output_of("gdal_translate -ot Int16 '" + text + "' '" + dir + "whole.tif'");
  testing::output_of("gdal_edit.py -a_ullr 0 0 26.5 20.5 '" + dir + "whole.tif'");
  expect_the_same_import(dir + "whole.tif", 0.2, Vec2(26, 20), "whole metres");
}

TEST(Import, ByWindowsNamesTheRowsItCannotRead) {
  const std::string dir = testing::folder();
  const auto none = [](int, int) -> std::string { return "-9999"; };
  testing::write_text(dir + "none.asc",
                      testing::ascii_grid(9, 9, "xllcorner 0\nyllcorner 0\ncellsize 1\n", none));
  scene::Scene world = testing::map_world(dir + "none.asc", 0.5, Vec2(6, 6));
  Ground::Setup setup;
  setup.cell = 0.5;
  setup.nx = setup.ny = 12;
  try {
    import_terrain(world, setup, 0, 4);
    FAIL() << "a map without heights was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("are nodata"), std::string::npos) << error.what();
  }
  if (!testing::has_tool("gdal_translate")) GTEST_SKIP() << "gdal_translate (gdal-bin) is missing";
  const auto z = [](int c, int r) { return std::to_string(100 * c + r); };
  testing::write_text(dir + "map.asc",
                      testing::ascii_grid(9, 9, "xllcorner 0\nyllcorner 0\ncellsize 1\n", z));
  testing::output_of("gdal_translate -of PNG -ot UInt16 '" + dir + "map.asc' '" + dir + "map.png'");
  world.ground.file = dir + "map.png";
  world.ground.scale.has_heights = true;
  world.ground.scale.high = 10;
  world.ground.scale.cell = 1;
  try {
    import_terrain(world, setup, 0, 4);
    FAIL() << "a picture was read by windows";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gdal_translate -of GTiff"), std::string::npos)
        << error.what();
  }
}

/// More rows than are computed at once.
Ground::Setup tall() { return testing::wavy_setup(24, 700); }

TEST(Export, OfManyRowsIsReadBackAsAWholeAndByWindows) {
  const std::string dir = testing::folder();
  const Ground ground(tall());
  write_geotiff(ground, dir + "tall.tif");
  expect_the_same_import(dir + "tall.tif", 0.1, Vec2(2.4, 70), "tall");
  const Ground read = make_ground(testing::map_world(dir + "tall.tif", 0.1, Vec2(2.4, 70)));
  for (int iy = 0; iy < 700; ++iy)
    for (int ix = 0; ix < 24; ++ix)
      // A float at a metre, and two roundings to quanta of mass.
      ASSERT_NEAR(read.height(ix, iy) + read.setup().height_offset, ground.height(ix, iy), 2e-7)
          << ix << " " << iy;
}

TEST(Export, LeavesNoFileWhenHeightsFail) {
  const std::string dir = testing::folder();
  Ground::Setup setup = tall();
  const SurfaceSource sound = setup.surface;
  // In the rows that another thread computes.
  setup.surface = [sound](int ix, int iy) { return iy == 90 ? std::nan("") : sound(ix, iy); };
  EXPECT_THROW(write_geotiff(Ground(setup), dir + "broken.tif"), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(dir));
}
#endif

}  // namespace
}  // namespace navvy::heightfield
