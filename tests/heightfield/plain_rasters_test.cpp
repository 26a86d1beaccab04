// SPDX-License-Identifier: Apache-2.0
// Maps without GDAL: the same heights, places and units as with it, and errors that say what to do.
#include "heightfield/map_files/plain_rasters.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "core/error.h"
#include "heightfield/map_files/ascii_words.h"
#include "heightfield/map_files/import.h"
#include "heightfield/map_files/side_files.h"
#include "heightfield/maps.h"
#ifdef NAVVY_WITH_PNG
#include "heightfield/png_writer.h"
#endif

namespace navvy::heightfield {
namespace {

using testing::ascii_grid;
using testing::folder;
using testing::map_world;
using testing::write_text;

/// A site of 8 x 4 columns of 1 m in the middle of a map.
Ground::Setup small_site() {
  Ground::Setup setup;
  setup.nx = 8, setup.ny = 4, setup.cell = 1;
  return setup;
}

// Heights without symmetry: mirroring or transposing changes nearly all cells.
double asymmetric(int column, int row) {
  return 100 + 1.25 * column + 7.5 * row + 0.5 * ((column * row * 5) % 7);
}
std::string asymmetric_text(int column, int row) { return std::to_string(asymmetric(column, row)); }

/// Returns the message of the readers without GDAL about a map, empty if they accept it.
std::string message_of(const scene::Scene& world) {
  try {
    Ground::Setup setup = small_site();
    import_terrain(world, setup, limits::kMapCells, WindowedRaster::kSide, MapReader::kPlain);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

#ifdef NAVVY_WITH_GDAL
/// What a reader makes of a map: everything but the name and the text of its CRS.
struct Found {
  Ground::Setup setup;
  TerrainReport report;
};

Found found_by(MapReader reader, const scene::Scene& world, double held = limits::kMapCells) {
  Found out{small_site(), {}};
  out.report = import_terrain(world, out.setup, held, 16, reader);
  return out;
}

/// Expects both readers to give the same site, to the last bit.
void expect_same(const Found& gdal, const Found& plain) {
  const Ground::Setup &a = gdal.setup, &b = plain.setup;
  for (int iy = 0; iy < a.ny; ++iy)
    for (int ix = 0; ix < a.nx; ++ix)
      ASSERT_EQ(a.surface(ix, iy), b.surface(ix, iy)) << ix << " " << iy;
  EXPECT_EQ(a.map_hash, b.map_hash);
  EXPECT_EQ(Vec2(a.easting, a.northing), Vec2(b.easting, b.northing));
  EXPECT_EQ(a.height_offset, b.height_offset);
  EXPECT_EQ(a.file_unit, b.file_unit);
  EXPECT_EQ(a.file_height_unit, b.file_height_unit);
  EXPECT_EQ(a.crs_wkt.empty(), b.crs_wkt.empty());
  EXPECT_EQ(a.filled_share, b.filled_share);
  const auto text = [](TerrainReport report) {
    // GDAL has its own names for CRS and units.
    report.crs = report.crs.empty() ? "" : "some";
    report.unit = report.height_unit = "";
    for (std::string& note : report.notes) note = note.substr(0, note.find('('));
    return report.text() + report.warning() + (report.point_registered ? " points" : "");
  };
  EXPECT_EQ(text(gdal.report), text(plain.report));
}

/// Expects GDAL, the readers without it, and the two together in the full build to agree.
void expect_same(const scene::Scene& world, double held = limits::kMapCells) {
  SCOPED_TRACE(world.ground.file);
  const Found gdal = found_by(MapReader::kGdal, world, held);
  expect_same(gdal, found_by(MapReader::kPlain, world, held));
  expect_same(gdal, found_by(MapReader::kBuild, world, held));
}

TEST(PlainRasters, ReadAsciiGridsAsGdalDoes) {
  const std::string dir = folder(), corner = "xllcorner 500\nyllcorner 8000.25\n";
  const auto expect = [&](const std::string& header,
                          const std::function<std::string(int, int)>& z = asymmetric_text) {
    expect_same(map_world(write_text(dir + "map.asc", ascii_grid(13, 7, header, z)), 1, {8, 4}));
  };
  expect(corner + "cellsize 1\n");
  expect("XLLCENTER -500\nYLLCENTER 8000.5\nCELLSIZE 2\nNODATA_VALUE -9999\n");
  expect(corner + "DX 1.5\nDY 0.75\n");
  expect("cellsize 1\n");
  expect("xllcorner 3\nyllcenter 4\ncellsize 1\n");
  expect(corner + "cellsize 1\ncellsize 2\n");
  // Every spelling of a gap and of a number.
  for (const char* word : {"-9999", "-9999,5", "nan", "-inf", "1e38", "1.#QNAN", "-1.#INF", "1e400",
                           "1e-400", "4,25", "+3", ".5", "5.", "-1.5E1", "0.1234567890123456789"}) {
    SCOPED_TRACE(word);
    const auto z = [&](int c, int r) { return c == 6 && r == 3 ? word : asymmetric_text(c, r); };
    expect(corner + "cellsize 1\n", z);
    expect(corner + "cellsize 1\nNODATA_value " + word + "\n", z);
  }
  // Rows that break elsewhere than the lines, blanks, and more numbers than the header says.
  std::string words = "ncols 13\r\nnrows 7\r\n" + corner + "cellsize 1\n\n  ";
  for (int i = 0; i < 13 * 7 + 5; ++i)
    words += asymmetric_text(i % 13, i / 13) + (i % 5 == 0 ? "\n" : "\t ");
  expect_same(map_world(write_text(dir + "words.asc", words + "end"), 1, {8, 4}));
}

TEST(PlainRasters, ReadRowsOfATallMapInAnyOrder) {
  // Far more rows than fit in a buffer; a site at either end, held and in windows.
  const std::string file = write_text(
      folder() + "tall.asc",
      ascii_grid(9, 20000, "xllcorner 0\nyllcorner 0\ncellsize 1\n", [](int c, int r) {
        return c == 3 && r % 1000 == 7 ? "-9999" : std::to_string(0.01 * r + asymmetric(c, r % 9));
      }));
  scene::Scene world = map_world(file, 1, Vec2(8, 4));
  world.ground.has_at = world.ground.at_is_local = true;
  for (const double y : {3.0, 10000.0, 19990.0}) {
    world.ground.at = Vec2(4.5, y);
    expect_same(world);
    expect_same(world, 10);
  }
  // The whole height of the map, in windows.
  const auto heights = [&](MapReader reader) {
    Ground::Setup setup = small_site();
    setup.ny = 20000;
    world.ground.at = Vec2(4.5, 10000);
    import_terrain(world, setup, 1000, 16, reader);
    return setup.map_hash;
  };
  EXPECT_EQ(heights(MapReader::kGdal), heights(MapReader::kPlain));
}

TEST(PlainRasters, ReadFilesBesideAnAsciiGridAsGdalDoes) {
  const std::string dir = folder(), map = dir + "map.asc";
  write_text(
      map, ascii_grid(13, 7, "xllcorner 981000\nyllcorner 195000\ncellsize 4\n", asymmetric_text));
  const scene::Scene world = map_world(map, 1, Vec2(8, 4));
  const std::string degrees =
      R"(GEOGCS["GCS_North_American_1983",DATUM["D_North_American_1983",SPHEROID["GRS_1980",)"
      R"(6378137.0,298.257222101]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])";
  const auto plane = [&](const std::string& unit) {
    return R"(PROJCS["NAD_1983_StatePlane_New_York_Long_Island",)" + degrees +
           R"(,PROJECTION["Lambert_Conformal_Conic"],PARAMETER["False_Easting",984250.0],)"
           R"(PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",-74.0],)"
           R"(PARAMETER["Standard_Parallel_1",41.0333333333333],)"
           R"(PARAMETER["Standard_Parallel_2",40.6666666666667],)"
           R"(PARAMETER["Latitude_Of_Origin",40.1666666666667],UNIT[)" +
           unit + "]]";
  };
  const std::string metre = R"("Meter",1.0)", survey = R"("Foot_US",0.3048006096012192)",
                    foot = R"("Foot",0.3048)",
                    vertical =
                        R"(,VERTCS["NAVD88",VDATUM["North_American_Vertical_Datum_1988"],)"
                        R"(PARAMETER["Vertical_Shift",0.0],PARAMETER["Direction",1.0],UNIT[)";
  for (const std::string& text :
       {plane(metre), plane(survey), plane(foot), plane(survey) + vertical + survey + "]]",
        plane(survey) + vertical + metre + "]]", std::string(R"(LOCAL_CS["site",UNIT["metre",1]])"),
        degrees}) {
    SCOPED_TRACE(text);
    write_text(dir + "map.PRJ", text + "\n");
    expect_same(world);
  }
  // Another map's file, as names differ in capitals.
  std::filesystem::rename(dir + "map.PRJ", dir + "MAP.prj");
  expect_same(world);
  // Units, scale and offset of GDAL's own file; place, CRS and nodata there do not count.
  const std::string tail =
      "</PAMRasterBand><PAMRasterBand band=\"2\"><Scale>9</Scale>"
      "</PAMRasterBand></PAMDataset>";
  for (const char* band :
       {"<UnitType>US survey foot</UnitType>", "<UnitType>cubit</UnitType>",
        "<Scale>0.5</Scale><Offset>3</Offset>", "<Offset>nan</Offset><Scale>0</Scale>",
        "<NoDataValue>101.25</NoDataValue>", "<UnitType>FT</UnitType>"}) {
    SCOPED_TRACE(band);
    write_text(map + ".aux.xml",
               "<PAMDataset><SRS>" + plane(foot) +
                   "</SRS><GeoTransform>1, 1, 0, 1, 0, -1</GeoTransform><PAMRasterBand "
                   "band=\"1\">" +
                   band + tail);
    expect_same(world);
  }
}

#ifdef NAVVY_WITH_PNG
scene::Scene picture_world(const std::string& file) {
  scene::Scene world = map_world(file, 1, Vec2(8, 4));
  world.ground.scale.cell = 1;
  world.ground.scale.has_heights = true;
  world.ground.scale.low = -3;
  world.ground.scale.high = 17;
  return world;
}

TEST(PlainRasters, ReadPicturesAsGdalDoes) {
  using testing::PngKind;
  const std::string dir = folder();
  for (const PngKind& kind :
       {PngKind{}, PngKind{8}, PngKind{4}, PngKind{1}, PngKind{16, PNG_COLOR_TYPE_GRAY_ALPHA},
        PngKind{8, PNG_COLOR_TYPE_GRAY_ALPHA}, PngKind{8, PNG_COLOR_TYPE_GRAY, true},
        PngKind{16, PNG_COLOR_TYPE_GRAY, false, 4321}, PngKind{8, PNG_COLOR_TYPE_GRAY, false, 200},
        PngKind{2, PNG_COLOR_TYPE_GRAY, true}}) {
    SCOPED_TRACE(::testing::Message() << kind.depth << " bits, type " << kind.color << ", "
                                      << kind.interlaced << ", " << kind.transparent);
    const auto gray = [&](int c, int r) {
      if (kind.transparent >= 0 && c == 5 && r == 3) return kind.transparent;
      return (4001 * c + 977 * r + 13 * c * r) & ((1 << kind.depth) - 1);
    };
    expect_same(picture_world(testing::write_png(dir + "map.png", 13, 7, kind, gray)));
  }
}

// GDAL 3.6 exchanges the bytes of such a picture; its own file without interlacing is the truth.
TEST(PlainRasters, ReadInterlacedPicturesOf16Bits) {
  using testing::PngKind;
  const std::string dir = folder();
  const auto gray = [](int c, int r) { return (4001 * c + 977 * r + 13 * c * r) % 65536; };
  const auto found = [&](bool interlaced) {
    const PngKind kind{16, PNG_COLOR_TYPE_GRAY, interlaced};
    return found_by(MapReader::kBuild,
                    picture_world(testing::write_png(dir + "map.png", 13, 7, kind, gray)));
  };
  const Found plain = found(false), interlaced = found(true);
  for (int iy = 0; iy < plain.setup.ny; ++iy)
    for (int ix = 0; ix < plain.setup.nx; ++ix)
      ASSERT_EQ(plain.setup.surface(ix, iy), interlaced.setup.surface(ix, iy)) << ix << " " << iy;
}

TEST(PlainRasters, ReadFilesBesideAPictureAsGdalDoes) {
  const std::string dir = folder(), map = dir + "map.png";
  testing::write_png(map, 26, 14, {}, [](int c, int r) { return 4001 * c % 65536 + 7 * r; });
  scene::Scene world = picture_world(map);
  world.ground.scale.cell = 0;
  const std::string srs =
      "PROJCS[&quot;NAD83 / UTM zone 15N&quot;,GEOGCS[&quot;NAD83&quot;,DATUM[&quot;North_American_"
      "Datum_1983&quot;,SPHEROID[&quot;GRS "
      "1980&quot;,6378137,298.257222101]],PRIMEM[&quot;Greenwich&quot;,0],UNIT[&quot;degree&quot;,"
      "0."
      "0174532925199433]],PROJECTION[&quot;Transverse_Mercator&quot;],PARAMETER[&quot;latitude_of_"
      "origin&quot;,0],PARAMETER[&quot;central_meridian&quot;,-93],PARAMETER[&quot;scale_factor&"
      "quot;,0.9996],PARAMETER[&quot;false_easting&quot;,500000],PARAMETER[&quot;false_northing&"
      "quot;,0],UNIT[&quot;metre&quot;,1]]";
  write_text(map + ".aux.xml",
             "<PAMDataset>\n<SRS dataAxisToSRSAxisMapping=\"1,2\">" + srs +
                 "</SRS>\n<GeoTransform>  5.0e+05,  5e-1, 0.0, 5.000003e+06, 0.0, -5e-1"
                 "</GeoTransform><PAMRasterBand band=\"1\"><NoDataValue>28007</NoDataValue>"
                 "</PAMRasterBand></PAMDataset>");
  expect_same(world);
  // World files, the preferred ones last.
  int number = 0;
  for (const char* ending : {"wld", "pngw", "pgw"}) {
    const std::string x = std::to_string(100.5 + ++number);
    write_text(dir + "map." + ending, "0.75\n0.0\n0.0\n-0.5\n" + x + "\n205,25\n");
    expect_same(world);
  }
  write_text(dir + "map.pgw", "0.75\n0.0\n");
  expect_same(world);
  // The scene's cell replaces all of them.
  expect_same(picture_world(map));
}
#endif
#endif

#ifdef NAVVY_WITH_PNG
TEST(PlainRasters, RefuseDamagedAndColouredPictures) {
  const std::string dir = folder(), map = dir + "map.png";
  const auto gray = [](int c, int r) { return (4001 * c + 977 * r * r) % 65536; };
  scene::Scene world = map_world(map, 1, Vec2(8, 4));
  world.ground.scale.cell = 1;
  world.ground.scale.has_heights = true;
  world.ground.scale.high = 5;
  testing::write_png(map, 200, 100, {}, gray);
  EXPECT_EQ(message_of(world), "");
  const auto bytes = std::filesystem::file_size(map);
  std::filesystem::resize_file(map, bytes / 3);
  expect_parts(message_of(world), {map, "row ", "libpng: ", "get it again"});
  std::filesystem::resize_file(map, 20);
  expect_parts(message_of(world), {map, "terrain", "libpng: ", "get it again"});
  testing::write_png(map, 13, 7, {8, PNG_COLOR_TYPE_RGB}, gray);
  expect_parts(message_of(world), {map, "3 bands", "colours", "16-bit gray"});
  testing::write_png(map, 13, 7, {8, PNG_COLOR_TYPE_PALETTE}, gray);
  expect_parts(message_of(world), {map, "1 bands", "colours", "16-bit gray"});
  // A picture of 8 bits is a map with a note.
  testing::write_png(map, 13, 7, {8}, gray);
  Ground::Setup setup = small_site();
  const TerrainReport report =
      import_terrain(world, setup, limits::kMapCells, 16, MapReader::kPlain);
  expect_parts(report.text(), {"8-bit heights: steps of 0.0196 m"});
  world.ground.scale.has_heights = false;
  expect_parts(message_of(world), {map, "heights", "map_heights_m"});
}
#endif

TEST(PlainRasters, RefuseDamagedAsciiGrids) {
  const std::string dir = folder(), map = dir + "map.asc";
  const auto message = [&](const std::string& text) {
    return message_of(map_world(write_text(map, text), 1, Vec2(8, 4)));
  };
  const std::string corner = "xllcorner 0\nyllcorner 0\n", sizes = "ncols 13\nnrows 7\n",
                    whole = ascii_grid(13, 7, corner + "cellsize 1\n", asymmetric_text);
  EXPECT_EQ(message(whole), "");
  expect_parts(message(whole.substr(0, whole.size() * 3 / 5)),
               {map, "row 4", "1 of its 13 numbers"});
  expect_parts(message(sizes + corner + "cellsize 1\n"), {map, "row 0", "0 of its 13 numbers"});
  expect_parts(message("nrows 7\n" + corner + "cellsize 1\n1 2"), {map, "ncols", "xllcorner"});
  expect_parts(message("ncols 1e9\nnrows 7\n" + corner + "cellsize 1\n1 2"),
               {map, "ncols", "'1000000000", "10 million"});
  expect_parts(message("ncols 13.5\nnrows 7\n" + corner + "cellsize 1\n1"), {map, "'13.5"});
  expect_parts(message("ncols nan\nnrows 7\n" + corner + "cellsize 1\n1"), {map, "ncols", "nan"});
  expect_parts(message("ncols abc\nnrows 7\n" + corner + "cellsize 1\n1"), {map + ":1:", "'abc'"});
  expect_parts(message(sizes + corner + "\n1 2 3"), {map, "cellsize", "dx and dy"});
  expect_parts(message(sizes + corner + "cellsize 1 2\n3 4"), {map + ":5:", "'2'", "behind"});
  expect_parts(message(sizes + corner + "cellsize 0\n1 2 3"), {map, "cells need an extent"});
  expect_parts(message(sizes + "xllcorner nan\nyllcorner 0\ncellsize 1\n1 2"),
               {map, "must be finite"});
  expect_parts(message(ascii_grid(
                   13, 7, corner + "cellsize 1\n",
                   [](int c, int r) { return c == 6 && r == 3 ? std::string("5;5") : "5.5"; })),
               {map + ":9:", "'5;5'", "NODATA_value"});
}

TEST(PlainRasters, RefuseOtherFormatsWithWhatToInstall) {
  const std::string dir = folder();
  scene::Scene world = map_world(write_text(dir + "map.tif", "II*\n"), 1, Vec2(8, 4));
  world.file = "site.sdf";
  world.ground.file_line = 7;
  expect_parts(message_of(world),
               {"site.sdf:7: error: terrain/file: '" + dir + "map.tif'", "16-bit PNG", "NPY",
                "ESRI ASCII", "gdal_translate -of AAIGrid", "libgdal-dev"});
}

#ifdef NAVVY_WITH_GDAL
TEST(PlainRasters, ReadAGeoTiffThatTheRemedyConverted) {
  if (!testing::has_tool("gdal_translate")) GTEST_SKIP() << "gdal_translate (gdal-bin) is missing";
  const std::string dir = folder(), tiff = dir + "map.tif";
  write_text(dir + "a.asc", ascii_grid(26, 14, "xllcorner 981000\nyllcorner 195000\ncellsize 4\n",
                                       asymmetric_text));
  for (const char* crs : {"EPSG:26915", "EPSG:2263", "EPSG:2263+6360"}) {
    SCOPED_TRACE(crs);
    testing::output_of(std::string("gdal_translate -ot Float32 -a_srs ") + crs + " '" + dir +
                       "a.asc' '" + tiff + "'");
    testing::output_of("gdal_translate -of AAIGrid '" + tiff + "' '" + dir + "out.asc'");
    const Found gdal = found_by(MapReader::kBuild, map_world(tiff, 1, Vec2(8, 4))),
                plain = found_by(MapReader::kPlain, map_world(dir + "out.asc", 1, Vec2(8, 4)));
    EXPECT_EQ(gdal.setup.map_hash, plain.setup.map_hash);
    EXPECT_EQ(gdal.setup.height_offset, plain.setup.height_offset);
    EXPECT_EQ(gdal.setup.easting, plain.setup.easting);
    EXPECT_EQ(gdal.setup.file_unit, plain.setup.file_unit);
    EXPECT_NEAR(gdal.setup.file_height_unit, plain.setup.file_height_unit, 1e-15);
  }
}
#endif

TEST(PlainRasters, RefuseFilesBesideAMapThatTheyCannotRead) {
  const std::string dir = folder(), map = dir + "map.asc";
  const scene::Scene world = map_world(
      write_text(map, ascii_grid(13, 7, "xllcorner 0\nyllcorner 0\ncellsize 1\n", asymmetric_text)),
      1, Vec2(8, 4));
  for (const char* text : {"Projection    UTM\nUnits FEET\n", "PROJCS[\"open\",UNIT[\"metre\",1]",
                           "PROJCS[\"no unit\"]", "PROJCRS[\"x\",LENGTHUNIT[\"metre\",1]]"}) {
    write_text(dir + "map.prj", text);
    expect_parts(message_of(world), {map, "CRS", "map.prj", "WKT 1", "gdalwarp"});
  }
  std::filesystem::remove(dir + "map.prj");
  write_text(map + ".aux.xml", "<PAMRasterBand band=\"1\"><Scale>two</Scale></PAMRasterBand>");
  expect_parts(message_of(world), {map, "'two'", "<Scale>", "map.asc.aux.xml"});
}

TEST(MapNumber, IsTheOneThatTheCLibraryReads) {
  for (const char* word : {"1.5", "-0.1", "1e38", "123456789.123456789", "5.", ".5", "-1.5E-3"})
    EXPECT_EQ(map_number(word), std::strtod(word, nullptr)) << word;
  EXPECT_EQ(map_number("4,25"), 4.25);
  EXPECT_EQ(map_number("+3"), 3.0);
  EXPECT_EQ(map_number("-1e999"), -INFINITY);
  EXPECT_EQ(map_number("1e-999"), 0.0);
  EXPECT_TRUE(std::isnan(map_number("1.#QNAN").value()));
  for (const char* word : {"", "abc", "1.2.3", "0x10", "+-5", "5;5", "+", "1e"})
    EXPECT_FALSE(map_number(word)) << word;
}

}  // namespace
}  // namespace navvy::heightfield
