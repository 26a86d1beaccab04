// SPDX-License-Identifier: Apache-2.0
// Golden pictures: small pictures in golden/ that a change of the renderer must not alter unseen.
// After a wanted change look at the new ones, which the failing test writes beside the build, and
// copy them over the old ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "paths.h"
#include "render/renderer.h"
#include "trench_scene.h"

namespace navvy::render {
namespace {

/// Share of the pixels that may differ by more than four grey levels: another processor rounds
/// edges of triangles to other pixels.
constexpr double kOther = 0.01;

void expect_golden(const std::string& name, const Image& image) {
  const std::string golden = source_dir() + "/tests/render/golden/" + name + ".png";
  const std::string now = build_dir() + "/golden_" + name + ".png";
  write_png(now, image);
  ASSERT_TRUE(std::filesystem::exists(golden)) << "copy " << now << " there";
  const Image wanted = read_png(golden);
  ASSERT_EQ(wanted.width, image.width);
  ASSERT_EQ(wanted.height, image.height);
  int other = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    int most = 0;
    for (std::size_t k = i; k < i + 3; ++k)
      most = std::max(most, std::abs(int{image.rgb[k]} - int{wanted.rgb[k]}));
    other += most > 4 ? 1 : 0;
  }
  EXPECT_LE(other, kOther * image.width * image.height) << "compare " << now << " with " << golden;
}

TEST(GoldenPictures, OfAMachineBesideItsTrench) {
  TrenchScene scene;
  make_trench_scene(scene, source_dir() + "/vehicles/ew180/meshes", 200);
  expect_golden("trench",
                Renderer().render(scene.frame, look_from({9, -7, 4}, {1.5, 0, 1}, 320, 180)));
}

TEST(GoldenPictures, OfLooseSoilOnTheGroundAndInTheAir) {
  scene::Frame frame;
  make_ground(frame.ground, 80, 80, 0.1);
  dig_trench(frame.ground, -2, -1.5);
  add_soil(frame.particles, {-0.8, 0.4, 0}, {0.6, 1.6, 0.5}, 0.1);
  add_soil(frame.particles, {0.9, 0.6, 0.9}, {1.3, 0.9, 1.1}, 0.1);
  expect_golden("loose_soil",
                Renderer().render(frame, look_from({3.5, -4, 2.5}, {0, 0, 0.2}, 320, 180)));
}

}  // namespace
}  // namespace navvy::render
