// SPDX-License-Identifier: Apache-2.0
// The folder for excavation planners read by NumPy, and the OBJ read by a few lines of Python.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "folder.h"
#include "formats/formats.h"
#include "heightfield/maps.h"
#include "map/grounds.h"

namespace navvy::formats {
namespace {

using nlohmann::json;

constexpr int kNx = 30, kNy = 22;

bool hole(int ix, int iy) { return ix == 9 && iy == 4; }
bool pit(int ix, int iy) { return ix >= 20 && ix < 26 && iy >= 3 && iy < 6; }
bool pad(int ix, int iy) { return ix < 4 && iy >= 15; }
bool bad(int ix, int iy) { return ix == 12 && iy > 10; }

map::TerrainMap example() {
  std::vector<float> z, target, good;
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) {
      z.push_back(hole(ix, iy) ? map::kUnknown : 1.0f + 0.25f * static_cast<float>(ix));
      const float off = pit(ix, iy) ? -1.0f : pad(ix, iy) ? 0.5f : 0.001f;
      target.push_back(ix > 27 ? map::kUnknown : z.back() + off);
      good.push_back(hole(ix, iy) ? map::kUnknown : bad(ix, iy) ? 0.0f : 0.75f);
    }
  return map::TerrainMap(map::testing::setup(kNx, kNy), 2, 1)
      .with(map::MapLayer::kElevation, z)
      .with(map::MapLayer::kTarget, target)
      .with(map::MapLayer::kTraversability, good);
}

bool has_numpy() { return std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") == 0; }

json python(const test::Folder& folder, const std::string& script, const std::string& path) {
  heightfield::testing::write_text(folder / "read.py", script);
  return json::parse(heightfield::testing::output_of("/usr/bin/python3 '" + folder / "read.py" +
                                                     "' '" + path + "'"),
                     nullptr, false);
}

TEST(Terra, IsReadByNumPyWithItsSignsAndDistances) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  write_map("terra", example(), {}, folder / "terra");
  const json read = python(folder, R"(
import json, numpy, sys
a = {k: numpy.load(f'{sys.argv[1]}/{k}/img_1.npy') for k in ('images', 'occupancy', 'dumpability', 'distance')}
print(json.dumps({k: [str(v.dtype), list(v.shape), v.tolist()] for k, v in a.items()}))
)",
                           folder / "terra");
  ASSERT_FALSE(read.is_discarded());
  EXPECT_EQ(read.at("images")[0], "int8");
  EXPECT_EQ(read.at("distance")[0], "float32");
  EXPECT_EQ(read.at("images")[1], json({kNy, kNx}));
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) {
      SCOPED_TRACE(std::to_string(ix) + " " + std::to_string(iy));
      const auto at = [&](const char* name) {
        return read.at(name)[2][static_cast<std::size_t>(iy)][static_cast<std::size_t>(ix)];
      };
      EXPECT_EQ(at("images"), pit(ix, iy) ? -1 : pad(ix, iy) ? 1 : 0);
      EXPECT_EQ(at("occupancy"), bad(ix, iy) || hole(ix, iy) ? 1 : 0);
      EXPECT_EQ(at("dumpability"), pit(ix, iy) || bad(ix, iy) || hole(ix, iy) ? 0 : 1);
      // The pit is a rectangle of columns 20..25 x 3..5.
      const double dx = std::max({20 - ix, ix - 25, 0}), dy = std::max({3 - iy, iy - 5, 0});
      EXPECT_NEAR(at("distance").get<double>(), 0.1 * std::hypot(dx, dy), 1e-6);
    }
}

TEST(Terra, HasNoDistanceWithoutSoilToDig) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  const std::vector<float> none(static_cast<std::size_t>(kNx) * kNy, map::kUnknown);
  write_map("terra", example().with(map::MapLayer::kTarget, none), {}, folder / "terra");
  const json read = python(folder, R"(
import json, numpy, sys
a = numpy.load(sys.argv[1] + '/distance/img_1.npy')
print(json.dumps([float(a.min()), float(a.max())]))
)",
                           folder / "terra");
  EXPECT_EQ(read, json({-1.0, -1.0}));
  EXPECT_THROW(
      write_map("terra", map::TerrainMap(map::testing::setup(kNx, kNy), 0, 1), {}, folder / "none"),
      InputError);
}

TEST(Obj, HoldsKnownColumnsAndUpwardFaces) {
  const test::Folder folder;
  write_map("obj", example(), {map::MapLayer::kElevation}, folder / "map.obj");
  const json read = python(folder, R"(
import json, sys
v, f = [], []
for line in open(sys.argv[1]):
    w = line.split()
    if w[0] == 'v': v.append([float(c) for c in w[1:]])
    if w[0] == 'f': f.append([int(c) - 1 for c in w[1:]])
area = 0
for a, b, c in f:
    p, q, r = v[a], v[b], v[c]
    one = ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / 2
    assert one > 0
    area += one
print(json.dumps([v, len(f), area]))
)",
                           folder / "map.obj");
  ASSERT_FALSE(read.is_discarded());
  ASSERT_EQ(read[0].size(), kNx * kNy - 1u);
  std::size_t k = 0;
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) {
      if (hole(ix, iy)) continue;
      const Vec2 p = map::testing::centre(map::testing::setup(kNx, kNy), ix, iy);
      EXPECT_EQ(read[0][k][0].get<double>(), p.x());
      EXPECT_EQ(read[0][k][1].get<double>(), p.y());
      EXPECT_EQ(read[0][k][2].get<float>(), 1.0f + 0.25f * static_cast<float>(ix));
      ++k;
    }
  // Two triangles per square of four columns; the hole removes six of the eight in the squares at
  // its corners.
  const int squares = (kNx - 1) * (kNy - 1);
  EXPECT_EQ(read[1], 2 * squares - 6);
  EXPECT_NEAR(read[2].get<double>(), 0.01 * squares - 0.03, 1e-9);
  EXPECT_THROW(write_map("obj", example(), {map::MapLayer::kTraversability}, folder / "map.obj"),
               InputError);
}

}  // namespace
}  // namespace navvy::formats
