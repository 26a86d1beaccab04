// SPDX-License-Identifier: Apache-2.0
// Every format is read back by an independent reader: gdalinfo and gdallocationinfo, NumPy,
// Python's zlib for PNG pixels, and nav2's loading rules. The grid is not square, has holes, is far
// from its map's origin and is marked in one corner, so that a wrong axis, flip or half cell is
// detected.
#include "formats/formats.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "folder.h"
#include "heightfield/maps.h"
#include "map/grounds.h"

namespace navvy::formats {
namespace {

using heightfield::testing::has_tool;
using heightfield::testing::output_of;
using heightfield::testing::write_text;

constexpr int kNx = 52, kNy = 36;

/// Returns true for the uniquely marked columns: greatest x, least y.
bool marked(int ix, int iy) { return ix >= kNx - 2 && iy < 1; }
bool hole(int ix, int iy) { return ix >= 10 && ix < 13 && iy >= 20 && iy < 22; }

float elevation(int ix, int iy) {
  if (hole(ix, iy)) return map::kUnknown;
  return marked(ix, iy)
             ? 9.0f
             : static_cast<float>(0.5 * std::sin(0.2 * ix) + 0.03 * iy - 0.001 * ix * iy);
}
float good(int ix, int iy) {
  if (hole(ix, iy)) return map::kUnknown;
  return marked(ix, iy) ? 0.0f : static_cast<float>(ix + 1) / (kNx + 1);
}

map::TerrainMap example() {
  heightfield::GroundSetup s = map::testing::setup(kNx, kNy);
  s.easting = 1540000.25;
  s.northing = 5150000.5;
  s.height_offset = 412;
  s.filled_share = 0.25;
  s.filled_from = 1.5;
  s.crs_wkt =
      "PROJCS[\"WGS 84 / UTM zone 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
      "84\",6378137,298.257223563,"
      "AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],PRIMEM[\"Greenwich\",0],UNIT["
      "\"degree\","
      "0.0174532925199433],AUTHORITY[\"EPSG\",\"4326\"]],PROJECTION[\"Transverse_Mercator\"],"
      "PARAMETER["
      "\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER[\"scale_factor\",0."
      "9996],PARAMETER["
      "\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1],AUTHORITY["
      "\"EPSG\",\"32632\"]]";
  std::vector<float> z, t;
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) z.push_back(elevation(ix, iy)), t.push_back(good(ix, iy));
  return map::TerrainMap(s, 12.5, 3)
      .with(map::MapLayer::kElevation, z)
      .with(map::MapLayer::kTraversability, t);
}

const std::vector<map::MapLayer> kTwo = {map::MapLayer::kElevation, map::MapLayer::kTraversability};

bool has_numpy() { return std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") == 0; }

/// Returns the output of the Python `script` as JSON; the file's path is sys.argv[1].
nlohmann::json python(const test::Folder& folder, const std::string& script,
                      const std::string& file) {
  write_text(folder / "read.py", "import json, sys\n" + script);
  return nlohmann::json::parse(
      output_of("/usr/bin/python3 '" + folder / "read.py" + "' '" + file + "'"), nullptr, false);
}

// Decodes a PNG by its standard [filters 0 to 4], with Python's zlib only: prints width, height,
// channels and the pixels.
const char* const kPng = R"(
import struct, zlib
d = open(sys.argv[1], 'rb').read()
assert d[:8] == b'\x89PNG\r\n\x1a\n'
at, idat = 8, b''
while at < len(d):
    n, kind = struct.unpack('>I4s', d[at:at + 8])
    body = d[at + 8:at + 8 + n]
    assert zlib.crc32(kind + body) == struct.unpack('>I', d[at + 8 + n:at + 12 + n])[0]
    if kind == b'IHDR': w, h, depth, colour, _, _, lace = struct.unpack('>IIBBBBB', body)
    if kind == b'IDAT': idat += body
    at += 12 + n
assert depth == 8 and lace == 0
c = {0: 1, 4: 2, 2: 3, 6: 4}[colour]
raw, out, old = zlib.decompress(idat), [], [0] * (w * c)
for y in range(h):
    f, row = raw[y * (w * c + 1)], list(raw[y * (w * c + 1) + 1:(y + 1) * (w * c + 1)])
    for i in range(w * c):
        a, b, e = row[i - c] if i >= c else 0, old[i], old[i - c] if i >= c else 0
        p = a + b - e
        near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - e), 2, e))[2]
        row[i] = (row[i] + [0, a, b, (a + b) // 2, near][f]) % 256
    out += row
    old = row
print(json.dumps([w, h, c, out]))
)";

TEST(GeoTiff, IsReadByGdalWithPlacesNamesUnitsAndHoles) {
  if (!has_tool("gdallocationinfo") || !has_tool("gdalinfo")) GTEST_SKIP() << "gdal-bin is missing";
  const test::Folder folder;
  write_map("geotiff", example(), kTwo, folder / "map.tif");
  std::vector<Vec2> points;
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix)
      points.push_back(Vec2(1540000.25, 5150000.5) + 0.1 * Vec2(ix + 0.5, iy + 0.5));
  const std::vector<double> values = heightfield::testing::located(folder / "map.tif", points);
  ASSERT_EQ(values.size(), 2 * points.size());
  for (int iy = 0, i = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix, i += 2) {
      const auto k = static_cast<std::size_t>(i);
      // Half an ulp of float at 412 m; traversability exactly.
      ASSERT_NEAR(values[k], hole(ix, iy) ? -9999 : static_cast<double>(elevation(ix, iy)) + 412,
                  3e-5);
      ASSERT_NEAR(values[k + 1], hole(ix, iy) ? -9999 : static_cast<double>(good(ix, iy)), 1e-7);
    }
  const nlohmann::json info = nlohmann::json::parse(
      output_of("gdalinfo -json '" + folder / "map.tif" + "'"), nullptr, false);
  ASSERT_FALSE(info.is_discarded());
  EXPECT_EQ(info["size"], (nlohmann::json{kNx, kNy}));
  EXPECT_EQ(info["bands"][0]["description"], "elevation");
  EXPECT_EQ(info["bands"][0]["unit"], "m");
  EXPECT_EQ(info["bands"][1]["description"], "traversability");
  EXPECT_EQ(info["bands"][1]["unit"], "-");
  EXPECT_EQ(info["bands"][1]["type"], "Float32");
  EXPECT_EQ(info["bands"][1]["noDataValue"], -9999.0);
  EXPECT_EQ(info["metadata"][""]["AREA_OR_POINT"], "Area");
  EXPECT_EQ(info["metadata"][""]["NAVVY_FILLED_SHARE"], "0.25");
  EXPECT_EQ(info["metadata"][""]["NAVVY_FILLED_FROM_M"], "1.5");
  EXPECT_NEAR(info["geoTransform"][0].get<double>(), 1540000.25, 1e-9);
  EXPECT_NEAR(info["geoTransform"][3].get<double>(), 5150000.5 + 3.6, 1e-9);
  EXPECT_NE(info["coordinateSystem"]["wkt"].get<std::string>().find("32632"), std::string::npos);
}

TEST(GeoTiff, WritesHeightsInFeetForASiteInFeet) {
  if (!has_tool("gdallocationinfo") || !has_tool("gdalinfo")) GTEST_SKIP() << "gdal-bin is missing";
  const test::Folder folder;
  heightfield::GroundSetup s = example().setup();
  s.file_height_unit = 0.3048;
  const map::TerrainMap map = map::TerrainMap(s, 0, 1).with(
      map::MapLayer::kElevation, example().copy(map::MapLayer::kElevation));
  write_map("geotiff", map, {map::MapLayer::kElevation}, folder / "feet.tif");
  EXPECT_NE(output_of("gdalinfo '" + folder / "feet.tif" + "'").find("Unit Type: ft"),
            std::string::npos);
  const double x = 1540000.25 + 0.35, y = 5150000.5 + 0.45;
  EXPECT_NEAR(heightfield::testing::located(folder / "feet.tif", {Vec2(x, y)}).at(0),
              (static_cast<double>(elevation(3, 4)) + 412) / 0.3048, 1e-4);
}

TEST(Npz, IsReadByNumpyWithItsHeader) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy for /usr/bin/python3 is missing (python3-numpy)";
  const test::Folder folder;
  write_map("npz", example(), kTwo, folder / "map.npz");
  const nlohmann::json read = python(folder, R"(
import numpy, zipfile
assert zipfile.ZipFile(sys.argv[1]).testzip() is None
n = numpy.load(sys.argv[1])
out = {k: numpy.where(numpy.isnan(n[k]), None, n[k].astype(float)).tolist() for k in ('elevation', 'traversability')}
out['types'] = sorted({(str(n[k].dtype), bool(n[k].flags.c_contiguous)) for k in out})
out['header'] = json.loads(n['header.json'].decode())
print(json.dumps(out)))",
                                     folder / "map.npz");
  ASSERT_FALSE(read.is_discarded());
  EXPECT_EQ(read["types"].dump(), R"([["float32",true]])");
  ASSERT_EQ(read["elevation"].size(), static_cast<std::size_t>(kNy));
  ASSERT_EQ(read["elevation"][0].size(), static_cast<std::size_t>(kNx));
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) {
      const auto& z = read["elevation"][static_cast<std::size_t>(iy)][static_cast<std::size_t>(ix)];
      const auto& t =
          read["traversability"][static_cast<std::size_t>(iy)][static_cast<std::size_t>(ix)];
      ASSERT_EQ(z.is_null(), hole(ix, iy));
      ASSERT_EQ(t.is_null(), hole(ix, iy));
      if (hole(ix, iy)) continue;
      ASSERT_EQ(z.get<double>(), static_cast<double>(elevation(ix, iy))) << ix << " " << iy;
      ASSERT_EQ(t.get<double>(), static_cast<double>(good(ix, iy)));
    }
  const nlohmann::json& header = read["header"];
  EXPECT_EQ(header["nx"], kNx);
  EXPECT_EQ(header["ny"], kNy);
  EXPECT_EQ(header["cell_m"], 0.1);
  EXPECT_EQ(header["origin_m"], (nlohmann::json{-3.3, 1.7}));
  EXPECT_EQ(header["time_s"], 12.5);
  EXPECT_EQ(header["sequence"], 3);
  EXPECT_EQ(header["layers"]["elevation"]["unit"], "m");
  EXPECT_EQ(header["soils"], (nlohmann::json{"loam", "topsoil"}));
  EXPECT_EQ(header["georeference"]["easting"], 1540000.25);
  EXPECT_EQ(header["georeference"]["height_offset_m"], 412);
  EXPECT_EQ(header["georeference"]["crs_wkt"], example().setup().crs_wkt);
  EXPECT_EQ(header["filled"]["share"], 0.25);
  EXPECT_EQ(header["filled"]["from_m"], 1.5);
}

TEST(Npz, HoldsAllRowsOfALargeMapInOrder) {
  const test::Folder folder;
  const map::TerrainMap map = map::testing::map_of(
      map::testing::setup(31, 600), [](double x, double y) { return 0.1 * x + y * y; });
  const std::vector<map::MapLayer> layers = {map::MapLayer::kElevation, map::MapLayer::kStepHeight};
  write_map("npz", map, layers, folder / "tall.npz");
  const std::vector<char> bytes = read_file(folder / "tall.npz");
  const std::string text(bytes.begin(), bytes.end());
  for (const map::MapLayer layer : layers) {
    // The entry's name is followed by NPY's header of 128 bytes, and then by the numbers.
    const std::size_t name = text.find(map::info(layer).name + ".npy"),
                      begin = text.find("\x93NUMPY", name) + 128;
    const std::vector<float> values = map.copy(layer);
    ASSERT_LE(begin + values.size() * sizeof(float), text.size());
    EXPECT_EQ(std::memcmp(text.data() + begin, values.data(), values.size() * sizeof(float)), 0)
        << map::info(layer).name;
  }
  if (!has_tool("python3")) GTEST_SKIP() << "python3 is missing";
  EXPECT_EQ(
      output_of(
          "python3 -c 'import sys, zipfile; print(zipfile.ZipFile(sys.argv[1]).testzip())' '" +
          (folder / "tall.npz") + "'"),
      "None\n");
}

TEST(Npz, IsReproducibleByteForByte) {
  const test::Folder folder;
  write_map("npz", example(), kTwo, folder / "a.npz");
  write_map("npz", example(), kTwo, folder / "b.npz");
  EXPECT_EQ(read_file(folder / "a.npz"), read_file(folder / "b.npz"));
}

/// Returns the keys of a nav2 YAML file, read by PyYAML.
nlohmann::json yaml(const test::Folder& folder, const std::string& file) {
  return python(folder, "import yaml\nprint(json.dumps(yaml.safe_load(open(sys.argv[1]))))\n",
                file);
}

/// Returns the value that map_server puts into the OccupancyGrid for one pixel, by nav2's
/// documented rules.
int loaded(const std::string& mode, double brightness, bool opaque, double free, double occupied) {
  const double p = 1 - brightness;
  if (mode == "scale" && !opaque) return -1;
  if (p > occupied) return 100;
  if (p < free) return 0;
  return mode == "scale" ? static_cast<int>(std::rint(100 * (p - free) / (occupied - free))) : -1;
}

bool has_yaml() { return std::system("/usr/bin/python3 -c 'import yaml' >/dev/null 2>&1") == 0; }

void expect_keys(const nlohmann::json& keys, const char* image, const char* mode) {
  EXPECT_EQ(keys["image"], image);
  EXPECT_EQ(keys["mode"], mode);
  EXPECT_EQ(keys["resolution"], 0.1);
  EXPECT_EQ(keys["origin"], (nlohmann::json{-3.3, 1.7, 0.0}));
  EXPECT_EQ(keys["negate"], 0);
  EXPECT_TRUE(keys["occupied_thresh"].is_number());
  EXPECT_TRUE(keys["free_thresh"].is_number());
}

TEST(Nav2, TrinaryLoadsAsFreeOccupiedAndUnknownWithCommonThresholds) {
  if (!has_yaml()) GTEST_SKIP() << "PyYAML for /usr/bin/python3 is missing (python3-yaml)";
  const test::Folder folder;
  write_map("nav2", example(), {map::MapLayer::kTraversability}, folder / "map.yaml");
  const nlohmann::json keys = yaml(folder, folder / "map.yaml");
  expect_keys(keys, "map.pgm", "trinary");
  const std::vector<char> pgm = read_file(folder / "map.pgm");
  const std::string head = "P5\n52 36\n255\n";
  ASSERT_EQ(pgm.size(), head.size() + kNx * kNy);
  EXPECT_EQ(std::string(pgm.begin(), pgm.begin() + static_cast<std::ptrdiff_t>(head.size())), head);
  // The file's own thresholds, and the threshold at which the saver's 205 becomes free ground.
  for (const double free : {keys["free_thresh"].get<double>(), 0.25})
    for (int y = 0; y < kNy; ++y)
      for (int ix = 0; ix < kNx; ++ix) {
        const int iy = kNy - 1 - y;  // msg.data[width * (height - y - 1) + x]
        const auto pixel =
            static_cast<std::uint8_t>(pgm[head.size() + static_cast<std::size_t>(y * kNx + ix)]);
        const int expected = hole(ix, iy) ? -1 : marked(ix, iy) ? 100 : 0;
        ASSERT_EQ(loaded("trinary", pixel / 255.0, true, free, keys["occupied_thresh"]), expected)
            << ix << " " << iy;
      }
  EXPECT_EQ(loaded("trinary", 205 / 255.0, true, 0.25, 0.65), 0) << "the file has no trap";
  if (has_tool("gdalinfo"))
    EXPECT_NE(output_of("gdalinfo '" + folder / "map.pgm" + "'").find("Size is 52, 36"),
              std::string::npos);
}

TEST(Nav2, ScaleLoadsAsOccupancyToAPercentWithHolesUnknown) {
  if (!has_yaml()) GTEST_SKIP() << "PyYAML for /usr/bin/python3 is missing (python3-yaml)";
  const test::Folder folder;
  write_map("nav2-scale", example(), {map::MapLayer::kTraversability}, folder / "map.yaml");
  const nlohmann::json keys = yaml(folder, folder / "map.yaml");
  expect_keys(keys, "map.png", "scale");
  const nlohmann::json png = python(folder, kPng, folder / "map.png");
  ASSERT_FALSE(png.is_discarded());
  ASSERT_EQ(png[0], kNx);
  ASSERT_EQ(png[1], kNy);
  ASSERT_EQ(png[2], 2);
  for (int y = 0; y < kNy; ++y)
    for (int ix = 0; ix < kNx; ++ix) {
      const int iy = kNy - 1 - y;
      const auto at = static_cast<std::size_t>(2 * (y * kNx + ix));
      const int got = loaded("scale", png[3][at].get<int>() / 255.0, png[3][at + 1] == 255,
                             keys["free_thresh"], keys["occupied_thresh"]);
      // 8 bits and the rounding to whole percents: 0.2 + 0.5.
      if (hole(ix, iy))
        ASSERT_EQ(got, -1);
      else
        ASSERT_NEAR(got, 100 * (1 - static_cast<double>(good(ix, iy))), 0.71) << ix << " " << iy;
    }
}

TEST(Pictures, AreNorthUpLitFromTheNorthWestWithTransparentHoles) {
  if (!has_numpy()) GTEST_SKIP() << "/usr/bin/python3 is missing";
  const test::Folder folder;
  // A pyramid in the south-east quarter of a plain.
  heightfield::GroundSetup s = map::testing::setup(kNx, kNy);
  std::vector<float> z;
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix)
      z.push_back(hole(ix, iy)
                      ? map::kUnknown
                      : std::max(0.0f, 0.8f - 0.1f * static_cast<float>(std::abs(ix - 40) +
                                                                        std::abs(iy - 9))));
  const map::TerrainMap map = map::TerrainMap(s, 0, 1).with(map::MapLayer::kElevation, z);
  write_map("hillshade", map, {map::MapLayer::kElevation}, folder / "shade.png");
  const nlohmann::json png = python(folder, kPng, folder / "shade.png");
  ASSERT_FALSE(png.is_discarded());
  ASSERT_EQ(png[0], kNx);
  ASSERT_EQ(png[1], kNy);
  ASSERT_EQ(png[2], 4);
  const auto pixel = [&](int ix, int iy, int c) {
    return png[3][static_cast<std::size_t>(4 * ((kNy - 1 - iy) * kNx + ix) + c)].get<int>();
  };
  // Level ground under a sun at 45 deg
  EXPECT_EQ(pixel(2, 2, 0), std::lround(255 * std::sqrt(0.5)));
  // Faces of 45 deg along both axes: the north-west one faces the sun, the south-east one faces
  // away.
  EXPECT_EQ(pixel(38, 11, 0), std::lround(255 * (2 + std::sqrt(2.0)) / 2 / std::sqrt(3.0)));
  EXPECT_EQ(pixel(42, 7, 0), 0);
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) ASSERT_EQ(pixel(ix, iy, 3), hole(ix, iy) ? 0 : 255);
}

TEST(Pictures, UseTheWholeRangeOfColours) {
  if (!has_numpy()) GTEST_SKIP() << "/usr/bin/python3 is missing";
  const test::Folder folder;
  write_map("relief", example(), {map::MapLayer::kTraversability}, folder / "good.png");
  const nlohmann::json png = python(folder, kPng, folder / "good.png");
  ASSERT_FALSE(png.is_discarded());
  const auto pixel = [&](int ix, int iy, int c) {
    return png[3][static_cast<std::size_t>(4 * ((kNy - 1 - iy) * kNx + ix) + c)].get<int>();
  };
  EXPECT_GT(pixel(kNx - 1, 0, 0), 3 * pixel(kNx - 1, 0, 1) / 2) << "the marked corner is red";
  EXPECT_GT(pixel(kNx - 4, 30, 1), pixel(kNx - 4, 30, 0)) << "drivable ground is green";
  EXPECT_EQ(pixel(11, 21, 3), 0);
  EXPECT_THROW(write_map("relief", example(), kTwo, folder / "two.png"), InputError);
  EXPECT_THROW(
      write_map("hillshade", example(), {map::MapLayer::kTraversability}, folder / "none.png"),
      InputError);
}

TEST(Ply, HoldsKnownColumnsAndUpwardFaces) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy for /usr/bin/python3 is missing (python3-numpy)";
  const test::Folder folder;
  write_map("ply", example(), {map::MapLayer::kTraversability}, folder / "map.ply");
  const nlohmann::json read = python(folder, R"(
import numpy as np
d = open(sys.argv[1], 'rb').read()
head, body = d.split(b'end_header\n', 1)
words = head.decode().split('\n')
nv = int([w for w in words if w.startswith('element vertex')][0].split()[2])
nf = int([w for w in words if w.startswith('element face')][0].split()[2])
properties = [' '.join(w.split()[1:]) for w in words if w.startswith('property')]
assert properties[:4] == ['double x', 'double y', 'double z', 'float traversability']
v = np.frombuffer(body, [('p', '<f8', 3), ('t', '<f4')], nv)
f = np.frombuffer(body, [('n', 'u1'), ('i', '<i4', 3)], nf, v.nbytes)
assert len(body) == v.nbytes + f.nbytes and (f['n'] == 3).all()
a, b, c = (v['p'][f['i'][:, k]] for k in range(3))
up = np.cross(b - a, c - a)[:, 2]
print(json.dumps([nv, nf, float(up.min()), float(up.sum() / 2), v['p'].tolist(), v['t'].astype(float).tolist()])))",
                                     folder / "map.ply");
  ASSERT_FALSE(read.is_discarded());
  ASSERT_EQ(read[0], kNx * kNy - 6);
  // Two faces per square of columns, except for those at a hole of 3 x 2: 4 x 3 squares, two
  // triangles of which are complete at the ends of the diagonals.
  EXPECT_EQ(read[1], 2 * (kNx - 1) * (kNy - 1) - 2 * 12 + 2);
  EXPECT_GT(read[2].get<double>(), 0);
  EXPECT_NEAR(read[3].get<double>(), 0.01 * read[1].get<double>() / 2, 1e-9);
  for (int iy = 0, i = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) {
      if (hole(ix, iy)) continue;
      const auto& p = read[4][static_cast<std::size_t>(i)];
      ASSERT_NEAR(p[0].get<double>(), -3.3 + 0.1 * (ix + 0.5), 1e-12);
      ASSERT_NEAR(p[1].get<double>(), 1.7 + 0.1 * (iy + 0.5), 1e-12);
      ASSERT_EQ(p[2].get<double>(), static_cast<double>(elevation(ix, iy)));
      ASSERT_EQ(read[5][static_cast<std::size_t>(i++)].get<double>(),
                static_cast<double>(good(ix, iy)));
    }
}

TEST(Formats, KeepTheOldFileWhenTheDiskIsFull) {
  const test::Folder folder;
  const map::TerrainMap map = example();
  for (const MapFormat& format : all_formats()) {
    if (format.extension.empty()) continue;
    const std::string path = folder / format.name + format.extension;
    write_text(path, "old");
    rlimit before;
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit little{100, before.rlim_max};
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &little);
    std::string message;
    try {
      const bool one = format.by_default.size() == 1;
      format.write(map, one ? format.by_default : kTwo, path);
    } catch (const FileError& error) {
      message = error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find((folder / format.name)), std::string::npos)
        << format.name << ": " << message;
    EXPECT_EQ(std::filesystem::file_size(path), 3u) << format.name;
    EXPECT_FALSE(std::filesystem::exists(path + ".part")) << format.name;
  }
}

/// Returns every file below a folder with its content.
std::map<std::string, std::vector<char>> content_of(const std::string& folder) {
  std::map<std::string, std::vector<char>> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      out[entry.path().lexically_relative(folder)] = read_file(entry.path().string());
  return out;
}

map::TerrainMap with_target() {
  std::vector<float> z = example().copy(map::MapLayer::kElevation);
  for (float& each : z) each -= 1;
  return example().with(map::MapLayer::kTarget, z);
}

TEST(Formats, KeepTheOldFolderWhenTheDiskIsFull) {
  const test::Folder folder;
  const map::TerrainMap map = with_target();
  for (const auto& [name, limit] :
       {std::pair<std::string, rlim_t>{"terra", 2000}, {"bag", 60000}}) {
    const MapFormat& format = format_named(name);
    const std::string path = folder / name;
    format.write(map, format.by_default, path);
    const auto before = content_of(path);
    ASSERT_EQ(before.size(), name == "terra" ? 4u : 2u);
    rlimit old;
    ::getrlimit(RLIMIT_FSIZE, &old);
    const rlimit little{limit, old.rlim_max};
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &little);
    std::string message;
    try {
      format.write(map, format.by_default, path);
    } catch (const FileError& error) {
      message = error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &old);
    ::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find(path), std::string::npos) << name << ": " << message;
    EXPECT_EQ(content_of(path), before) << name;
    EXPECT_FALSE(std::filesystem::exists(path + ".part")) << name;
    // With space again the new folder replaces the old one as a whole; leftovers of a kill do not
    // interfere.
    std::filesystem::create_directories(path + ".part/" + name);
    std::filesystem::remove(path + "/" + before.rbegin()->first);
    format.write(map, format.by_default, path + "/");
    EXPECT_EQ(content_of(path).size(), before.size()) << name;
    EXPECT_FALSE(std::filesystem::exists(path + ".part")) << name;
  }
}

TEST(Formats, NeverModifyAForeignFolder) {
  const test::Folder folder;
  for (const std::string name : {"terra", "bag"}) {
    const MapFormat& format = format_named(name);
    const std::string mine = folder / (name + "_mine"), part = folder / (name + "_part"),
                      file = folder / (name + "_f");
    std::filesystem::create_directories(mine + "/images");
    write_text(mine + "/images/img_2.npy", "precious");
    std::filesystem::create_directories(part + ".part");
    write_text(part + ".part/notes", "precious");
    write_text(file, "precious");
    for (const std::string& path : {mine, part, file}) {
      std::string message;
      try {
        format.write(with_target(), format.by_default, path);
      } catch (const Error& error) {
        message = error.what();
      }
      EXPECT_NE(message.find("name a"), std::string::npos) << path << ": " << message;
      EXPECT_THROW(require_writable(format, path), Error) << path;
    }
    EXPECT_EQ(content_of(folder.path().string()).size(), 3u);
    EXPECT_FALSE(std::filesystem::exists(part));
    // Through a link, and through folders that do not exist yet.
    std::filesystem::create_directory_symlink("deep/" + name, folder / "link");
    EXPECT_NO_THROW(require_writable(format, folder / "link"));
    format.write(with_target(), format.by_default, folder / "link");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    for (const std::string& each : files_of(format, folder / ("deep/" + name)))
      EXPECT_TRUE(std::filesystem::exists(each) || each.ends_with("-journal")) << each;
    for (const char* end : {"_mine", "_part.part", "_f", ""})
      std::filesystem::remove_all(folder / (name + end));
    std::filesystem::remove_all(folder / "deep");
    std::filesystem::remove(folder / "link");
  }
  EXPECT_EQ(files_of(format_named("nav2"), "a/map.yaml"),
            (std::vector<std::string>{"a/map.yaml", "a/map.pgm"}));
}

TEST(Formats, AreFoundByNameWithASuggestionOtherwise) {
  for (const MapFormat& format : all_formats()) EXPECT_EQ(&format_named(format.name), &format);
  try {
    format_named("geotif");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'geotiff'?"), std::string::npos)
        << error.what();
  }
  const test::Folder folder;
  EXPECT_THROW(write_map("nav2", example(), kTwo, folder / "map.yaml"), InputError);
  EXPECT_THROW(write_map("nav2", example(), {map::MapLayer::kTraversability}, folder / "map.pgm"),
               InputError);
  EXPECT_THROW(write_map("geotiff", example(), {}, folder / "map.tif"), Error);
}

// Two independent readers see the same pixels.
TEST(Pictures, AreReadEquallyByPillowAndByTheStandard) {
  if (std::system("/usr/bin/python3 -c 'import PIL' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "Pillow for /usr/bin/python3 is missing (python3-pil)";
  const char* const script = R"(
from PIL import Image
i = Image.open(sys.argv[1])
i.load()
assert i.format == 'PNG'
print(json.dumps([i.width, i.height, len(i.getbands()), list(i.tobytes())]))
)";
  const test::Folder folder;
  write_map("hillshade", example(), {map::MapLayer::kElevation}, folder / "shade.png");
  write_map("relief", example(), {map::MapLayer::kTraversability}, folder / "good.png");
  write_map("nav2-scale", example(), {map::MapLayer::kTraversability}, folder / "map.yaml");
  for (const char* name : {"shade.png", "good.png", "map.png"}) {
    const nlohmann::json seen = python(folder, script, folder / name);
    ASSERT_FALSE(seen.is_discarded()) << name;
    EXPECT_EQ(seen[0], kNx) << name;
    EXPECT_EQ(seen, python(folder, kPng, folder / name)) << name;
  }
}

}  // namespace
}  // namespace navvy::formats
