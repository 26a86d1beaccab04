// SPDX-License-Identifier: Apache-2.0
#include "heightfield/map_files/npy.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/error.h"
#include "heightfield/make_ground.h"
#include "heightfield/maps.h"

namespace navvy::heightfield {
namespace {

using testing::folder;
using testing::map_world;
using testing::output_of;
using testing::write_text;

/// Returns an NPY of version 1 as numpy.save writes it.
std::string npy(const std::string& descr, const std::string& order, const std::string& shape,
                const std::string& data) {
  std::string header =
      "{'descr': " + descr + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  header.append((64 - (header.size() + 11) % 64) % 64, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size() % 256);
  out += static_cast<char>(header.size() / 256);
  return out + header + data;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}

std::string message_of(const std::string& path) {
  try {
    read_npy(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const std::vector<float> kSix = {0, 1, 2, 3, 4, 5};

TEST(Npy, IsReadInTheOrderOfTheFile) {
  const std::string path =
      write_text(folder() + "a.npy", npy("'<f4'", "False", "(2, 3)", bytes_of(kSix)));
  EXPECT_TRUE(is_npy_file(path));
  const NpyGrid grid = read_npy(path);
  EXPECT_EQ(grid.rows, 2);
  EXPECT_EQ(grid.columns, 3);
  EXPECT_EQ(grid.type, NpyType::kFloat32);
  EXPECT_EQ(std::string(grid.bytes.begin(), grid.bytes.end()), bytes_of(kSix));
}

TEST(Npy, RefusesOtherArraysWithFileKeyValueAndRemedy) {
  const std::string dir = folder(), data = bytes_of(kSix);
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    const std::string message = message_of(write_text(dir + "bad.npy", text));
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    EXPECT_NE(message.find("bad.npy"), std::string::npos) << message;
  };
  expect(npy("'<f4'", "True", "(2, 3)", data), {"fortran_order", "'True'", "ascontiguousarray"});
  expect(npy("'>f4'", "False", "(2, 3)", data), {"descr", ">f4", "little-endian", "astype"});
  expect(npy("'<c8'", "False", "(2, 3)", data), {"descr", "<c8"});
  expect(npy("[('z', '<f4')]", "False", "(2, 3)", data), {"descr", "[('z'"});
  expect(npy("'<f4'", "False", "(6,)", data), {"shape", "(6,)", "two axes"});
  expect(npy("'<f4'", "False", "(1, 2, 3)", data), {"shape", "(1, 2, 3)"});
  expect(npy("'<f4'", "False", "(0, 3)", ""), {"shape", "(0, 3)"});
  expect(npy("'<f4'", "False", "(2, -3)", data), {"shape"});
  expect(npy("'<f4'", "False", "(999999999, 999999999)", data),
         {"24 bytes", "999999999 x 999999999"});
  expect(npy("'<f4'", "False", "(2, 3)", data.substr(4)),
         {"byte 128", "20 bytes", "cut or damaged"});
  expect(npy("'<f4'", "False", "(2, 3)", data + "x"), {"25 bytes"});
  expect(npy("'<f4'", "False", "(2, 3)", data).substr(0, 40), {"byte 8", "damaged"});
  expect("no array", {"byte 0", "numpy.save"});
  expect("", {"byte 0"});
}

// Heights without symmetry on a grid that is not square.
double asymmetric(int column, int row) {
  return 3 + 0.25 * column + 1.5 * row + 0.125 * ((column * row * 5) % 7);
}

scene::Scene world_of(const std::string& path) {
  scene::Scene world = map_world(path, 0.5, Vec2(6, 4));
  world.ground.scale.cell = 0.5;
  return world;
}

TEST(Npy, OfNumPyItselfGivesItsHeights) {
  if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "NumPy is missing";
  const std::string dir = folder();
  write_text(dir + "make.py", R"(
import numpy, sys
c, r = numpy.meshgrid(numpy.arange(12), numpy.arange(8))
z = 3 + 0.25 * c + 1.5 * r + 0.125 * ((c * r * 5) % 7)
for kind in ('<f4', '<f8'): numpy.save(sys.argv[1] + kind[1:], z.astype(kind))
numpy.save(sys.argv[1] + 'north', z[::-1].astype('<f4').copy())
for kind in ('<i2', '<i4', '<u2', '|u1'): numpy.save(sys.argv[1] + kind[1:], (8 * z).astype(kind))
)");
  output_of("/usr/bin/python3 '" + dir + "make.py' '" + dir + "'");
  for (const std::string kind : {"f4", "f8", "north", "i2", "i4", "u2", "u1"}) {
    scene::Scene world = world_of(dir + kind + ".npy");
    world.ground.scale.north_first = kind == "north";
    const Ground ground = make_ground(world);
    const double factor = kind[0] == 'i' || kind[0] == 'u' ? 8 : 1;
    // Row 0 has least y by default. Whole numbers are floats of three digits.
    for (int iy = 0; iy < 8; ++iy)
      for (int ix = 0; ix < 12; ++ix)
        ASSERT_NEAR(ground.height(ix, iy) + ground.setup().height_offset,
                    factor * asymmetric(ix, iy), 1e-5)
            << kind << " " << ix << " " << iy;
  }
}

TEST(Npy, NeedsACellSizeAndRecognisesGaps) {
  const std::string dir = folder();
  std::vector<float> z(96, 2.0f);
  z[40] = std::nanf("");
  const std::string path = write_text(dir + "a.npy", npy("'<f4'", "False", "(8, 12)", bytes_of(z)));
  std::string report;
  make_ground(world_of(path), &report);
  EXPECT_NE(report.find("1 of 96 cells on the site (1.04 %), filled from up to 0.5 m away"),
            std::string::npos)
      << report;
  EXPECT_NE(report.find("first row south"), std::string::npos) << report;
  scene::Scene world = world_of(path);
  world.ground.scale.cell = 0;
  EXPECT_THROW(make_ground(world), InputError);
  world = world_of(path);
  world.ground.scale.has_heights = true;
  EXPECT_THROW(make_ground(world), InputError);
}

#ifdef NAVVY_WITH_GDAL
TEST(Png, OfSixteenBitsSpansHeightsFromBlackToWhite) {
  if (!testing::has_tool("gdal_translate")) GTEST_SKIP() << "gdal_translate (gdal-bin) is missing";
  const std::string dir = folder();
  write_text(
      dir + "map.asc",
      testing::ascii_grid(12, 8, "xllcorner 0\nyllcorner 0\ncellsize 0.5\n", [](int c, int r) {
        return std::to_string(static_cast<int>(3000 * asymmetric(c, 7 - r)));
      }));
  output_of("gdal_translate -of PNG -ot UInt16 '" + dir + "map.asc' '" + dir + "map.png'");
  // Keep only the picture: GDAL's file beside it contains its place.
  std::filesystem::remove(dir + "map.png.aux.xml");
  scene::Scene world = world_of(dir + "map.png");
  EXPECT_THROW(make_ground(world), InputError) << "a picture without heights";
  world.ground.scale.has_heights = true;
  world.ground.scale.low = -2;
  world.ground.scale.high = 65535 / 3000.0 - 2;
  const Ground ground = make_ground(world);
  // A grey value is a third of a millimetre here.
  for (int iy = 0; iy < 8; ++iy)
    for (int ix = 0; ix < 12; ++ix)
      ASSERT_NEAR(ground.height(ix, iy) + ground.setup().height_offset, asymmetric(ix, iy) - 2,
                  3.5e-4)
          << ix << " " << iy;
  // Other files define their own cells.
  world.ground.file = dir + "map.asc";
  EXPECT_THROW(make_ground(world), InputError);
}
#endif

}  // namespace
}  // namespace navvy::heightfield
