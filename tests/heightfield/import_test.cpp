// SPDX-License-Identifier: Apache-2.0
#ifdef NAVVY_WITH_GDAL
#include "heightfield/map_files/import.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <set>

#include "core/error.h"
#include "core/limits.h"
#include "heightfield/make_ground.h"
#include "heightfield/maps.h"

namespace navvy::heightfield {
namespace {

using testing::ascii_grid;
using testing::folder;
using testing::has_tool;
using testing::located;
using testing::map_world;
using testing::output_of;
using testing::write_text;

// A surface without symmetry: mirroring or transposing a 13 x 7 map of it changes nearly all cells.
double asymmetric(int column, int row) {
  return 100 + 1.25 * column + 7.5 * row + 0.5 * ((column * row * 5) % 7);
}
std::string asymmetric_text(int column, int row) { return std::to_string(asymmetric(column, row)); }

std::string asymmetric_map(const std::string& path,
                           const std::string& corner = "xllcorner 500\nyllcorner 8000\n") {
  return write_text(path, ascii_grid(13, 7, corner + "cellsize 1\n", asymmetric_text));
}

std::string message_of(const scene::Scene& world) {
  try {
    make_ground(world);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Expects every column of a site whose columns coincide with the cells of the map to match
// gdallocationinfo.
void expect_as_located(const std::string& file, const Ground& ground, double tolerance) {
  const Ground::Setup& setup = ground.setup();
  std::vector<Vec2> points;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix)
      points.push_back(Vec2(setup.easting, setup.northing) +
                       setup.cell / setup.file_unit * Vec2(ix + 0.5, iy + 0.5));
  const std::vector<double> values = located(file, points);
  ASSERT_EQ(values.size(), points.size());
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix)
      ASSERT_NEAR((ground.height(ix, iy) + setup.height_offset) / setup.file_height_unit,
                  values[static_cast<std::size_t>(iy) * ground.nx() + ix], tolerance)
          << ix << ", " << iy;
}

// Float of a height within 100 m of the offset, plus the mass quantum of a 1 m2 column.
constexpr double kFloatHeight = 1e-5;

TEST(Import, IsNeitherMirroredNorTransposed) {
  if (!has_tool("gdallocationinfo")) GTEST_SKIP() << "gdallocationinfo (gdal-bin) is missing";
  const std::string file = asymmetric_map(folder() + "map.asc");
  scene::Scene world = map_world(file, 1, Vec2(8, 4));
  world.ground.has_at = true;
  for (const Vec2& at : {Vec2(505, 8003), Vec2(508, 8004), Vec2(509, 8002)}) {
    world.ground.at = at;
    const Ground ground = make_ground(world);
    EXPECT_EQ(ground.nx(), 8);
    EXPECT_EQ(ground.ny(), 4);
    EXPECT_EQ(Vec2(ground.setup().easting, ground.setup().northing), Vec2(at - Vec2(4, 2)));
    expect_as_located(file, ground, kFloatHeight);
  }
  // Local coordinates count from the lower-left corner and give the same place.
  world.ground.at = Vec2(5, 3);
  world.ground.at_is_local = true;
  const Ground local = make_ground(world);
  EXPECT_EQ(local.setup().easting, 501);
  EXPECT_NEAR(local.height(0, 0) + local.setup().height_offset, asymmetric(1, 5), kFloatHeight);
}

TEST(Import, PlacesPointAndAreaFilesLikeOtherPrograms) {
  if (!has_tool("gdallocationinfo") || !has_tool("gdal_translate"))
    GTEST_SKIP() << "gdal-bin is missing";
  const std::string dir = folder(), ascii = asymmetric_map(dir + "map.asc");
  for (const std::string kind : {"Area", "Point"}) {
    const std::string file = dir + kind + ".tif";
    output_of("gdal_translate -ot Float32 -a_srs EPSG:26915 -mo AREA_OR_POINT=" + kind + " '" +
              ascii + "' '" + file + "'");
    scene::Scene world = map_world(file, 1, Vec2(8, 4));
    world.ground.has_at = true;
    world.ground.at = Vec2(506, 8004);
    Ground::Setup setup;
    setup.nx = 8, setup.ny = 4, setup.cell = 1;
    const TerrainReport report = import_terrain(world, setup);
    EXPECT_EQ(report.point_registered, kind == "Point");
    EXPECT_TRUE(contains(report.crs, "UTM zone 15N")) << report.crs;
    EXPECT_TRUE(contains(setup.crs_wkt, "PROJCRS"));
    expect_as_located(file, make_ground(world), kFloatHeight);
  }
  // ESRI's way to register at points: the corner is half a cell lower.
  const std::string centred =
      asymmetric_map(dir + "centre.asc", "xllcenter 500.5\nyllcenter 8000.5\n");
  scene::Scene world = map_world(centred, 1, Vec2(8, 4));
  world.ground.has_at = true;
  world.ground.at = Vec2(506, 8004);
  const Ground ground = make_ground(world);
  EXPECT_NEAR(ground.height(0, 0) + ground.setup().height_offset, asymmetric(2, 4), kFloatHeight);
}

TEST(Import, ReadsCellsThatAreNotSquare) {
  const std::string file =
      write_text(folder() + "map.asc",
                 ascii_grid(20, 6, "XLLCORNER 0\nYLLCORNER 0\nDX 0.5\nDY 2\n",
                            [](int c, int r) { return std::to_string(0.5 * c + 3 * (5 - r)); }));
  const Ground ground = make_ground(map_world(file, 0.1, Vec2(4, 4)));
  // A plane of slope 1 along x and 1.5 along y, whatever the cells are.
  const double left = ground.sample(-1.5, 0), right = ground.sample(1.5, 0);
  EXPECT_NEAR(right - left, 3, 1e-5);
  EXPECT_NEAR(ground.sample(0, 1.5) - ground.sample(0, -1.5), 4.5, 1e-5);
}

TEST(Import, RecognisesEverySpellingOfNodata) {
  const std::string dir = folder();
  struct Case {
    std::string name, header, cell;
  };
  const std::vector<Case> cases = {
      {"usual", "NODATA_value -9999\n", "-9999"},
      {"odd", "NODATA_value -9999.005859375\n", "-9999.005859375"},
      {"float", "NODATA_value -3.4028230607370965e+38\n", "-3.4028230607370965e+38"},
      {"infinite", "NODATA_value -inf\n", "-inf"},
      {"undeclared", "", "-9999"},
      {"undeclared_float", "", "-3.4028230607370965e+38"},
      {"nan", "", "nan"}};
  for (const Case& c : cases) {
    const auto z = [&](int column, int row) {
      return column >= 9 && column < 12 && row == 10 ? c.cell : std::to_string(5.5 + 0.25 * column);
    };
    const std::string header = "xllcorner 0\nyllcorner 0\ncellsize 1\n" + c.header;
    const std::string file = write_text(dir + c.name + ".asc", ascii_grid(21, 21, header, z));
    scene::Scene world = map_world(file, 0.5, Vec2(12, 12));
    Ground::Setup setup;
    setup.nx = setup.ny = 24, setup.cell = 0.5;
    const TerrainReport report = import_terrain(world, setup);
    EXPECT_EQ(report.nodata.gaps, 3) << c.name;
    EXPECT_EQ(report.nodata.farthest, 1) << c.name;
    EXPECT_TRUE(contains(report.text(), "3 of ")) << report.text();
    // The middle of the gap is between its neighbours, as the rows above and below are complete.
    EXPECT_NEAR(setup.surface(12, 12) + report.height_offset, 5.5 + 0.25 * 10, 0.2) << c.name;
    EXPECT_LT(report.slope.most, radians(20)) << c.name;
  }
}

TEST(Import, KeepsZeroNegativeAndHighHeights) {
  const std::string dir = folder();
  for (const double base : {0.0, -431.5, 4807.25}) {
    const auto z = [&](int c, int r) {
      return std::to_string(base + (c + r == 0 ? 0.0 : 0.125 * (c % 3)));
    };
    const std::string file = write_text(
        dir + "map.asc",
        ascii_grid(16, 16, "xllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n", z));
    const Ground ground = make_ground(map_world(file, 1, Vec2(16, 16)));
    EXPECT_NEAR(ground.height(4, 5) + ground.setup().height_offset, base + 0.125, kFloatHeight)
        << base;
    EXPECT_LT(std::abs(ground.height(4, 5)), 2) << base;  // W heights are small
    EXPECT_EQ(ground.setup().height_offset, std::floor(ground.setup().height_offset));
  }
  // A map without any height is refused.
  const std::string empty =
      write_text(dir + "empty.asc",
                 ascii_grid(16, 16, "xllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n",
                            [](int, int) { return "-9999"; }));
  EXPECT_TRUE(contains(message_of(map_world(empty, 1, Vec2(8, 8))), "are nodata"));
}

TEST(Import, ReportsTheExtentOfTheMapWhenTheSiteIsOffIt) {
  const std::string file = asymmetric_map(folder() + "map.asc");
  scene::Scene world = map_world(file, 0.1, Vec2(4, 4));
  world.ground.has_at = true;
  world.ground.at = Vec2(5, 3);
  const std::string message = message_of(world);
  EXPECT_TRUE(contains(message, "500.000 .. 513.000")) << message;
  EXPECT_TRUE(contains(message, "8000.000 .. 8007.000")) << message;
  EXPECT_TRUE(contains(message, "local:")) << message;
  world.ground.has_at = false;
  world.ground.size = Vec2(14, 4);
  EXPECT_TRUE(contains(message_of(world), "off the map"));
  // The whole map, rounded up to blocks, is still on the map.
  world.ground.size = Vec2(13, 7);
  EXPECT_EQ(make_ground(world).ny(), 72);
}

TEST(Import, RefusesDegreesWithTheRemedyAndRecognisesWrongLabels) {
  if (!has_tool("gdal_translate")) GTEST_SKIP() << "gdal-bin is missing";
  const std::string dir = folder();
  const std::string small = write_text(
      dir + "small.asc",
      ascii_grid(13, 7, "xllcorner -93.9\nyllcorner 46.5\ncellsize 0.00001\n", asymmetric_text));
  output_of("gdal_translate -a_srs EPSG:4326 '" + small + "' '" + dir + "degrees.tif'");
  const std::string message = message_of(map_world(dir + "degrees.tif", 0.1, Vec2(4, 4)));
  EXPECT_TRUE(contains(message, "degrees")) << message;
  EXPECT_TRUE(contains(message, "gdalwarp -t_srs EPSG:32615")) << message;
  const std::string metres = asymmetric_map(dir + "map.asc");
  output_of("gdal_translate -a_srs EPSG:4326 '" + metres + "' '" + dir + "false.tif'");
  std::string report;
  const Ground ground = make_ground(map_world(dir + "false.tif", 0.5, Vec2(4, 4)), &report);
  EXPECT_TRUE(contains(report, "taken as metres, CRS dropped")) << report;
  EXPECT_TRUE(ground.setup().crs_wkt.empty());
}

// Returns the report of a map under a site of 10 x 10 m in its middle.
TerrainReport report_of(const std::string& file) {
  Ground::Setup setup;
  setup.nx = setup.ny = 40, setup.cell = 0.25;
  return import_terrain(map_world(file, 0.25, Vec2(10, 10)), setup);
}

bool notes(const TerrainReport& report, const std::string& part) {
  return std::any_of(report.notes.begin(), report.notes.end(),
                     [&](const std::string& note) { return contains(note, part); });
}

TEST(Import, ReportsTheFilledShareItsSourceAndTheRemedy) {
  const std::string dir = folder(), header = "xllcorner 0\nyllcorner 0\ncellsize 1\n";
  const auto plane = [](int c, int r) { return std::to_string(100.125 + 0.5 * c + 0.25 * r); };
  // A hole of 7 x 7 cells: its middle is the fourth cell from any height.
  const auto holed = [&](const std::string& gap) {
    return [=](int c, int r) { return c >= 6 && c < 13 && r >= 7 && r < 14 ? gap : plane(c, r); };
  };
  const std::string whole = write_text(dir + "whole.asc", ascii_grid(20, 20, header, plane));
  EXPECT_EQ(report_of(whole).warning(), "");
  EXPECT_EQ(make_ground(map_world(whole, 0.25, Vec2(10, 10))).setup().filled_share, 0);
  const std::string holes = write_text(
      dir + "holes.asc", ascii_grid(20, 20, header + "NODATA_value -9999\n", holed("-9999")));
  const TerrainReport report = report_of(holes);
  EXPECT_EQ(report.site_cells, 100);
  EXPECT_EQ(report.site_gaps, 49);
  const Ground filled = make_ground(map_world(holes, 0.25, Vec2(10, 10)));
  EXPECT_EQ(filled.setup().filled_share, 0.49);
  EXPECT_EQ(filled.setup().filled_from, 4);
  const std::string warning = report.warning();
  EXPECT_TRUE(contains(warning, "49 of 100 map cells on the site (49 %, 49 m2) have no height"))
      << warning;
  EXPECT_TRUE(contains(warning, "from up to 4 m away")) << warning;
  EXPECT_EQ(warning.find('\n'), std::string::npos) << warning;
  EXPECT_TRUE(
      contains(report.text(), "49 of 100 cells on the site (49 %), filled from up to 4 m away"))
      << report.text();
  // A gap beside the site is not counted.
  const auto beside = [&](int c, int r) { return c == 3 ? std::string("-9999") : plane(c, r); };
  const std::string margin =
      write_text(dir + "beside.asc", ascii_grid(20, 20, header + "NODATA_value -9999\n", beside));
  EXPECT_EQ(report_of(margin).nodata.gaps, 15);
  EXPECT_EQ(report_of(margin).warning(), "");
  // An undeclared nodata value.
  const std::string odd = write_text(dir + "odd.asc", ascii_grid(20, 20, header, holed("1e38")));
  const std::string undeclared = report_of(odd).warning();
  EXPECT_TRUE(contains(undeclared, "1e+38 cannot be a height of ground")) << undeclared;
  if (!has_tool("gdal_fillnodata.py") || !has_tool("gdal_translate"))
    GTEST_SKIP() << "gdal-bin is missing";
  ASSERT_TRUE(testing::run_remedy(warning, "gdal_fillnodata.py", holes, dir + "filled.tif"))
      << warning;
  EXPECT_EQ(report_of(dir + "filled.tif").warning(), "");
  ASSERT_TRUE(testing::run_remedy(undeclared, "gdal_translate", odd, dir + "declared.tif"))
      << undeclared;
  EXPECT_EQ(report_of(dir + "declared.tif").unmarked, 0);
  EXPECT_EQ(report_of(dir + "declared.tif").site_gaps, 49);
}

TEST(Import, NotesAStaircaseAndItsRemedy) {
  const std::string dir = folder(), header = "xllcorner 981000\nyllcorner 195000\ncellsize 1\n";
  const auto slope = [](double c, double r) { return 100 + 0.37 * c + 0.11 * r; };
  const auto map = [&](const std::string& name, const std::function<double(double)>& rounded) {
    const auto z = [&](int c, int r) { return std::to_string(rounded(slope(c, r))); };
    return write_text(dir + name, ascii_grid(32, 32, header, z));
  };
  const std::string stairs = map("stairs.asc", [](double z) { return std::round(z); });
  const TerrainReport report = report_of(stairs);
  EXPECT_TRUE(notes(report, "whole numbers of the metre: a staircase with steps of 1 m"))
      << report.text();
  EXPECT_FALSE(notes(report_of(map("fine.asc", [](double z) { return z; })), "staircase"));
  EXPECT_FALSE(notes(report_of(map("tenths.asc", [](double z) { return std::round(10 * z) / 10; })),
                     "staircase"));
  EXPECT_FALSE(notes(report_of(map("level.asc", [](double) { return 312.0; })), "staircase"));
  if (!has_tool("gdalwarp") || !has_tool("gdal_edit.py")) GTEST_SKIP() << "gdal-bin is missing";
  // Its remedy removes the staircase and keeps the heights.
  ASSERT_TRUE(testing::run_remedy(report.text(), "gdalwarp", stairs, dir + "smooth.tif"))
      << report.text();
  const TerrainReport smooth = report_of(dir + "smooth.tif");
  EXPECT_FALSE(notes(smooth, "staircase")) << smooth.text();
  EXPECT_LT(smooth.slope.most, report.slope.most);
  const Ground ground = make_ground(map_world(dir + "smooth.tif", 0.25, Vec2(10, 10)));
  EXPECT_NEAR(ground.height(20, 20) + ground.setup().height_offset, slope(15.625, 15.375), 0.25);
  // Whole feet, and whole metres converted to feet.
  const std::string feet = dir + "feet.tif", turned = dir + "turned.tif";
  output_of("gdal_translate -ot Float32 -a_srs EPSG:26915 '" + stairs + "' '" + feet + "'");
  output_of("gdal_edit.py -units ft '" + feet + "'");
  EXPECT_TRUE(
      notes(report_of(feet), "whole numbers of the ft: a staircase with steps of 0.3048 m"));
  output_of("gdal_translate -ot Float32 -a_srs EPSG:26915 '" +
            map("turned.asc", [](double z) { return std::round(z) / 0.3048; }) + "' '" + turned +
            "'");
  output_of("gdal_edit.py -units ft '" + turned + "'");
  EXPECT_TRUE(notes(report_of(turned), "whole numbers of the metre"));
}

TEST(Import, NamesRemediesThatWork) {
  for (const char* tool : {"gdal_translate", "gdalwarp", "gdal_edit.py"})
    if (!has_tool(tool)) GTEST_SKIP() << tool << " (gdal-bin) is missing";
  const std::string dir = folder();
  const auto z = [](int c, int r) { return std::to_string(100.25 + 0.5 * c + 0.3 * r); };
  // Rotated against its axes.
  const std::string plain = write_text(
      dir + "plain.asc", ascii_grid(30, 30, "xllcorner 0\nyllcorner 0\ncellsize 1\n", z));
  output_of("gdal_translate -of VRT '" + plain + "' '" + dir + "turned.vrt'");
  std::ifstream in(dir + "turned.vrt");
  std::string text(std::istreambuf_iterator<char>(in), {});
  const std::size_t begin = text.find("<GeoTransform>"), end = text.find("</GeoTransform>");
  ASSERT_NE(end, std::string::npos) << text;
  write_text(dir + "turned.vrt",
             text.replace(begin, end - begin, "<GeoTransform>0, 0.9, 0.1, 30, 0.1, -0.9"));
  output_of("gdal_translate '" + dir + "turned.vrt' '" + dir + "turned.tif'");
  std::string message = message_of(map_world(dir + "turned.tif", 0.5, Vec2(4, 4)));
  ASSERT_TRUE(testing::run_remedy(message, "gdalwarp", dir + "turned.tif", dir + "straight.tif"))
      << message;
  EXPECT_EQ(message_of(map_world(dir + "straight.tif", 0.5, Vec2(4, 4))), "");
  // Degrees.
  write_text(dir + "degrees.asc",
             ascii_grid(30, 30, "xllcorner -93.1\nyllcorner 44.9\ncellsize 0.0001\n", z));
  output_of("gdal_translate -a_srs EPSG:4326 '" + dir + "degrees.asc' '" + dir + "degrees.tif'");
  message = message_of(map_world(dir + "degrees.tif", 0.5, Vec2(4, 4)));
  ASSERT_TRUE(testing::run_remedy(message, "gdalwarp", dir + "degrees.tif", dir + "metres.tif"))
      << message;
  EXPECT_EQ(message_of(map_world(dir + "metres.tif", 0.5, Vec2(4, 4))), "");
  // Degrees by a wrong label, in a file that gdal_edit.py cannot write to: the message says to make
  // a copy that it can.
  write_text(dir + "label.asc", ascii_grid(90, 60, "xllcorner 100\nyllcorner 20\ncellsize 1\n", z));
  write_text(
      dir + "label.prj",
      "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137,298.257223563]],"
      "PRIMEM[\"Greenwich\",0],UNIT[\"Degree\",0.0174532925199433]]\n");
  message = message_of(map_world(dir + "label.asc", 0.5, Vec2(4, 4)));
  ASSERT_TRUE(testing::run_remedy(message, "gdal_translate", dir + "label.asc", dir + "label.tif"))
      << message;
  ASSERT_TRUE(testing::run_remedy(message, "gdal_edit.py", dir + "label.tif", dir + "label.tif"))
      << message;
  EXPECT_EQ(message_of(map_world(dir + "label.tif", 0.5, Vec2(4, 4))), "");
  // An unknown unit is noted with its remedy.
  output_of("gdal_translate -a_srs EPSG:26915 '" + plain + "' '" + dir + "unit.tif'");
  output_of("gdal_edit.py -units cubit '" + dir + "unit.tif'");
  const TerrainReport report = report_of(dir + "unit.tif");
  EXPECT_TRUE(notes(report, "heights in 'cubit'")) << report.text();
  ASSERT_TRUE(testing::run_remedy(report.text(), "gdal_edit.py", dir + "unit.tif", ""))
      << report.text();
  EXPECT_EQ(report_of(dir + "unit.tif").height_metres, 0.3048);
}

TEST(Import, ConvertsFeetOnAllThreeAxes) {
  if (!has_tool("gdal_translate") || !has_tool("gdallocationinfo"))
    GTEST_SKIP() << "gdal-bin is missing";
  const std::string dir = folder(),
                    ascii = asymmetric_map(dir + "map.asc", "xllcorner 981000\nyllcorner 195000\n");
  const std::string file = dir + "feet.tif";
  output_of("gdal_translate -ot Float32 -a_srs EPSG:2263 '" + ascii + "' '" + file + "'");
  const double foot = 1200.0 / 3937.0;  // US survey foot
  scene::Scene world = map_world(file, foot, Vec2(8 * foot, 4 * foot));
  world.ground.has_at = true;
  world.ground.at = Vec2(981006, 195004);
  std::string report;
  const Ground ground = make_ground(world, &report);
  EXPECT_TRUE(contains(report, "heights carry no unit")) << report;
  EXPECT_NEAR(ground.height(0, 0) + ground.setup().height_offset, asymmetric(2, 4) * foot,
              kFloatHeight);
  // One column of feet is 0.3048 m wide and 0.09 m2: the mass quantum stays below the float of a
  // height.
  expect_as_located(file, ground, 2 * kFloatHeight);
}

TEST(Import, ReportsSlopesAndRepose) {
  // A face of 45 deg in a plane: 2 of 15 steps between rows.
  const auto z = [](int, int r) { return std::to_string(r < 7 ? 2.0 : r == 7 ? 1.0 : 0.0); };
  const std::string file = write_text(
      folder() + "face.asc", ascii_grid(16, 16, "xllcorner 0\nyllcorner 0\ncellsize 1\n", z));
  Ground::Setup setup;
  setup.nx = setup.ny = 160, setup.cell = 0.1;
  const TerrainReport report = import_terrain(map_world(file, 0.1, Vec2(16, 16)), setup);
  EXPECT_NEAR(degrees(report.slope.most), 45, 1e-4);
  EXPECT_EQ(report.slope.least, 0);
  EXPECT_NEAR(report.slope.share_above, 2.0 / 15, 1e-12);
  // Once settled, it is no steeper than the friction angle.
  scene::Scene world = map_world(file, 0.1, Vec2(16, 16));
  world.ground.steep = scene::SteepGround::kSettle;
  const Ground settled = make_ground(world);
  double most = 0;
  for (int iy = 0; iy + 1 < settled.ny(); ++iy)
    most = std::max(most, std::abs(settled.height(80, iy + 1) - settled.height(80, iy)) / 0.1);
  EXPECT_LT(degrees(std::atan(most)), 30);
  // The finer soil grid has no slope that is not in the map.
  const Ground held = make_ground(map_world(file, 0.1, Vec2(16, 16)));
  for (int iy = 0; iy + 1 < held.ny(); ++iy)
    EXPECT_LE(std::abs(held.height(80, iy + 1) - held.height(80, iy)), 0.1 + 1e-6);
}

TEST(Import, AveragesAMapFinerThanTheSoilCell) {
  const auto z = [](int c, int r) { return std::to_string((c + r) % 2 == 0 ? 1.0 : 0.0); };
  const std::string file = write_text(
      folder() + "fine.asc", ascii_grid(80, 80, "xllcorner 0\nyllcorner 0\ncellsize 0.05\n", z));
  const Ground ground = make_ground(map_world(file, 0.2, Vec2(4, 4)));
  EXPECT_NEAR(ground.height(7, 9), 0.5, 1e-6);  // a chequerboard's mean, not one of its cells
}

TEST(Import, RefusesDamagedFilesWithoutOutputOfGdal) {
  const std::string dir = folder();
  const std::string junk = write_text(dir + "junk.tif", "II* this is no map");
  const std::string half = write_text(
      dir + "half.asc", "ncols 13\nnrows 7\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3");
  const std::string huge = write_text(
      dir + "huge.asc", "ncols 2000000000\nnrows 7\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3");
  const std::string zero = write_text(
      dir + "zero.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n1 2 3 4 5 6");
  const std::string nowhere =
      write_text(dir + "nowhere.asc",
                 ascii_grid(13, 7, "xllcorner nan\nyllcorner 0\ncellsize 1\n", asymmetric_text));
  ::testing::internal::CaptureStderr();
  for (const std::string& file : {junk, half, huge, zero, nowhere, dir, dir + "missing.tif"}) {
    const std::string message = message_of(map_world(file, 0.5, Vec2(4, 4)));
    EXPECT_TRUE(contains(message, file)) << file << ": " << message;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Import, RefusesAMapWhoseBlocksDecodeToFarMoreThanTheSite) {
  if (!has_tool("gdal_create")) GTEST_SKIP() << "gdal_create (gdal-bin) is missing";
  const std::string dir = folder();
  // Rows of one empty block each, so that a kilobyte of file stands for any number of rows.
  const auto made = [&](const std::string& name, const std::string& columns,
                        const std::string& rows) {
    const std::string size =
        " -outsize " + columns + " " + rows + " -a_ullr 0 " + rows + " " + columns + " 0 ";
    const std::string file = dir + name;
    EXPECT_EQ(
        std::system(("gdal_create -q -of GTiff -ot Float32 -co SPARSE_OK=TRUE -co BLOCKYSIZE=1" +
                     size + "'" + file + "'")
                        .c_str()),
        0);
    EXPECT_LT(std::filesystem::file_size(file), 10'000u);
    return file;
  };
  // Rows of 240 MB as doubles, every one of which is decoded for a site of 40 m: 10 GB.
  const std::string wide = made("wide.tif", "30000000", "60");
  const std::string message = message_of(map_world(wide, 0.5, Vec2(40, 40)));
  EXPECT_TRUE(contains(message, wide)) << message;
  EXPECT_TRUE(contains(
      message, "more than " + std::to_string(static_cast<std::int64_t>(limits::kMapDecodedBytes)) +
                   " to decode for this site"))
      << message;
  EXPECT_TRUE(contains(message, "gdal_translate -co TILED=YES")) << message;
  // The amount of work is refused, not the form: rows of 4 MB are read.
  EXPECT_EQ(message_of(map_world(made("narrow.tif", "1000000", "60"), 0.5, Vec2(40, 40)))
                .find("to decode"),
            std::string::npos);
}

TEST(Import, RefusesWordsAmongTheNumbersOfAnAsciiGrid) {
  const std::string header = "xllcorner 0\nyllcorner 0\ncellsize 1\n";
  const auto grid = [&](const std::string& word) {
    return ascii_grid(13, 7, header,
                      [&](int c, int r) { return c == 6 && r == 3 ? word : std::string("5.5"); });
  };
  // Row 3 of the heights is line 9: five lines of header before it.
  for (const char* word : {"abc", "12abc", "--3", "1.2.3", "0x10", "#", "5;5", "+", "-.", "+-5x"}) {
    const std::string file = write_text(folder() + "words.asc", grid(word));
    const std::string message = message_of(map_world(file, 0.5, Vec2(4, 4)));
    EXPECT_TRUE(contains(message, file + ":9: error: terrain: '" + std::string(word) + "'"))
        << message;
  }
  for (const char* number : {"7", "-1.5e-1", "+3", "5.", ".5", "4,25", "nan", "-9999", "1.#QNAN"}) {
    const std::string file = write_text(folder() + "numbers.asc", grid(number));
    EXPECT_EQ(message_of(map_world(file, 0.5, Vec2(4, 4))), "") << number;
  }
  const std::string key =
      write_text(folder() + "key.asc", ascii_grid(13, 7, header + "colour 3\n", asymmetric_text));
  EXPECT_TRUE(contains(message_of(map_world(key, 0.5, Vec2(4, 4))), "'colour'"));
}

TEST(Import, FindsAWordAcrossTheBuffersOfAFile) {
  // Seven bytes per height, 1400 per row: the first piece of 64 KiB ends in row 46 for any offset
  // by the blanks.
  constexpr int kRow = 46, kColumns = 200, kPiece = 1 << 16;
  const std::string dir = folder();
  for (int blanks = 0; blanks < 8; ++blanks) {
    const std::string header =
        "xllcorner 0\nyllcorner 0\ncellsize 1" + std::string(blanks, ' ') + "\n";
    const auto grid = [&](int bad) {
      return ascii_grid(kColumns, 50, header, [&](int c, int r) {
        return std::string(c == bad && r == kRow ? "12e.25" : "123.25");
      });
    };
    const std::string good = grid(-1);
    const std::size_t begin = good.find("123.25") + 7ul * kColumns * kRow;
    ASSERT_LT(begin, kPiece);
    ASSERT_GT(begin + 7ul * kColumns, kPiece);
    const int last = static_cast<int>((kPiece - 1 - begin) / 7);
    EXPECT_EQ(message_of(map_world(write_text(dir + "good.asc", good), 0.5, Vec2(4, 4))), "");
    for (const int bad : {last - 1, last, last + 1}) {
      const std::string file = write_text(dir + "bad.asc", grid(bad)),
                        message = message_of(map_world(file, 0.5, Vec2(4, 48)));
      EXPECT_TRUE(
          contains(message, file + ":" + std::to_string(kRow + 6) + ": error: terrain: '12e.25'"))
          << "[" << message << "] " << bad << " " << last;
    }
  }
}

TEST(Import, RefusesPipesAndDevicesAsMapsAndSidecarFiles) {
  const std::string dir = folder();
  ASSERT_EQ(::mkfifo((dir + "pipe.tif").c_str(), 0600), 0);
  for (const std::string& file : {dir + "pipe.tif", std::string("/dev/zero")})
    EXPECT_TRUE(contains(message_of(map_world(file, 0.5, Vec2(4, 4))), "is not a plain file"));
  const std::string map =
      write_text(dir + "Site.asc",
                 ascii_grid(13, 7, "xllcorner 0\nyllcorner 0\ncellsize 1\n", asymmetric_text));
  EXPECT_EQ(message_of(map_world(map, 0.5, Vec2(4, 4))), "");
  // Other files with the map's name do not matter; GDAL looks for capitals too.
  ASSERT_EQ(::mkfifo((dir + "Site.txt").c_str(), 0600), 0);
  EXPECT_EQ(message_of(map_world(map, 0.5, Vec2(4, 4))), "");
  for (const char* name : {"Site.prj", "SITE.PRJ", "Site.asc.aux.xml"}) {
    ASSERT_EQ(::mkfifo((dir + name).c_str(), 0600), 0);
    EXPECT_TRUE(contains(message_of(map_world(map, 0.5, Vec2(4, 4))),
                         std::string(name) + "': it is a pipe"))
        << name;
    std::filesystem::remove(dir + name);
  }
  write_text(dir + "Site.prj", std::string(limits::kMapSidecarBytes + 1, ' '));
  EXPECT_TRUE(
      contains(message_of(map_world(map, 0.5, Vec2(4, 4))), "a file beside a map may have"));
}

TEST(Import, ReadsTheLidarMapOfMinnesota) {
  const std::string file = testing::shared_data() + "/terrain/lidar_hummocky_1m.tif";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is missing";
  Ground::Setup setup;
  setup.nx = setup.ny = 4000, setup.cell = 0.1;
  const TerrainReport report = import_terrain(map_world(file, 0.1, Vec2(400, 400)), setup);
  std::printf("%s", report.text().c_str());
  // From the NOTICE beside the file: heights 379.66 .. 410.76 m, slope median 11.4, at most 35.7
  // deg (by their method).
  EXPECT_NEAR(report.lowest, 379.66, 0.01);
  EXPECT_NEAR(report.highest, 410.76, 0.01);
  EXPECT_NEAR(degrees(report.slope.median), 11.4, 0.5);
  EXPECT_NEAR(degrees(report.slope.most), 35.7, 3);
  EXPECT_EQ(report.nodata.gaps, 0);
  if (!has_tool("gdallocationinfo")) GTEST_SKIP() << "gdallocationinfo (gdal-bin) is missing";
  // Cells of 1 m, aligned with those of the map by an even size at a corner.
  scene::Scene world = map_world(file, 1, Vec2(60, 20));
  world.ground.has_at = world.ground.at_is_local = true;
  world.ground.at = Vec2(200, 311);
  const std::string dir = folder();
  std::filesystem::copy_file(file, dir + "map.tif");
  expect_as_located(dir + "map.tif", make_ground(world), kFloatHeight);
}

TEST(Import, ReadsTheChannelOfTheKootenai) {
  const std::string file = testing::shared_data() + "/terrain/kootenai_channel_1m.asc";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is missing";
  Ground::Setup setup;
  setup.nx = 500, setup.ny = 372, setup.cell = 0.1;
  const TerrainReport report = import_terrain(map_world(file, 0.1, Vec2(50, 37)), setup);
  std::printf("%s", report.text().c_str());
  EXPECT_EQ(report.columns, 50);
  EXPECT_EQ(report.rows, 37);
  EXPECT_NEAR(report.lowest, 537.36, 0.01);
  EXPECT_NEAR(report.highest, 543.81, 0.01);
  EXPECT_NEAR(degrees(report.slope.most), 57.6, 4);  // their difference formula differs
  EXPECT_TRUE(report.crs.empty());
  if (!has_tool("gdallocationinfo")) GTEST_SKIP() << "gdallocationinfo (gdal-bin) is missing";
  scene::Scene world = map_world(file, 1, Vec2(40, 28));
  world.ground.has_at = true;
  world.ground.at = Vec2(556465, 5394950);
  const std::string dir = folder();
  std::filesystem::copy_file(file, dir + "map.asc");
  expect_as_located(dir + "map.asc", make_ground(world), kFloatHeight);
}

}  // namespace
}  // namespace navvy::heightfield
#endif
