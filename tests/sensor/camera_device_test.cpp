// SPDX-License-Identifier: Apache-2.0
// Pictures of colour cameras, and depths from pairs of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sensor/camera/picture_scene.h"
#include "sensor/scenes.h"

namespace navvy::sensor {
namespace {

using testing::mast;
using testing::scene_of;
using testing::world_of;

std::string camera(const std::string& name, const std::string& type, int width, int height,
                   const std::string& more = "", const std::string& of_camera = "") {
  return "<sensor name=\"" + name + "\" type=\"" + type +
         "\"><pose>0 0 2.9 0 0.8 0</pose><update_rate>10</update_rate>" + more +
         "<camera><horizontal_fov>1</horizontal_fov><image><width>" + std::to_string(width) +
         "</width><height>" + std::to_string(height) + "</height></image>" + of_camera +
         "</camera></sensor>";
}

/// Returns a red box on the ground ahead of the mast.
std::string red_box() {
  return "<model name=\"box\"><static>true</static><pose>3.3 0.4 0 0 0 0</pose><link name=\"l\">"
         "<visual name=\"v\"><geometry><box><size>0.6 0.6 0.6</size></box></geometry><material>"
         "<diffuse>0.9 0.05 0.05 1</diffuse></material></visual></link></model>";
}

bool is_red(const std::uint8_t* p) { return p[0] > 60 && p[0] > 2 * p[1] && p[0] > 2 * p[2]; }

TEST(ColourCamera, SeesColoursWhereTheLabelCameraSeesTheThing) {
  device::Device device;
  const auto world = world_of(
      scene_of(mast(camera("eye", "camera", 96, 64) + camera("labels", "segmentation", 96, 64)) +
               red_box()),
      device);
  const auto eye = world->arrays().view("mast/eye/image");
  ASSERT_EQ(eye.channel().type_text(), "uint8[64,96,3]");
  ASSERT_EQ(eye.sequence(), 1u);
  const auto colours = eye.values<std::uint8_t>();
  const auto labels = world->arrays().view("mast/labels/labels").values<std::uint16_t>();
  int red = 0, of_box = 0, both = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const bool a = is_red(&colours[3 * i]), b = labels[i] == 4;
    red += a ? 1 : 0;
    of_box += b ? 1 : 0;
    both += a && b ? 1 : 0;
  }
  EXPECT_GT(of_box, 100);
  // Only pixels on the outline of the box may differ.
  EXPECT_GE(both, of_box - 40);
  EXPECT_LE(red, both + 40);
}

TEST(ColourCamera, HasNoiseOfItsDeviation) {
  device::Device device;
  const auto world =
      world_of(scene_of(mast(camera("clean", "camera", 160, 120) +
                             camera("noisy", "camera", 160, 120, "",
                                    "<noise><type>gaussian</type><stddev>0.02</stddev></noise>"))),
               device);
  const auto clean = world->arrays().view("mast/clean/image").values<std::uint8_t>(),
             noisy = world->arrays().view("mast/noisy/image").values<std::uint8_t>();
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    // Neither black nor white cuts off the errors.
    if (clean[i] < 30 || clean[i] > 225) continue;
    squares += (noisy[i] - clean[i]) * (noisy[i] - clean[i]);
    ++count;
  }
  ASSERT_GT(count, 10000);
  // Rounding to bytes adds a twelfth.
  const double expected = std::sqrt(0.02 * 255 * 0.02 * 255 + 1.0 / 12);
  EXPECT_NEAR(std::sqrt(squares / count), expected, 0.03 * expected);
}

/// Finds the columns by which the surroundings of a pixel of the left picture lie to the right of
/// those in the right picture, to a part of a pixel. A negative number: not found.
class Matcher {
 public:
  Matcher(std::span<const std::uint8_t> left, std::span<const std::uint8_t> right, int width)
      : left_(grey(left)), right_(grey(right)), width_(width) {}

  double disparity(int x, int y, int least, int most) const {
    std::vector<double> costs;
    for (int d = least; d <= most; ++d) costs.push_back(cost(x, y, d));
    const auto best = std::min_element(costs.begin(), costs.end());
    if (best == costs.begin() || best + 1 == costs.end()) return -1;
    const double before = best[-1], here = best[0], after = best[1];
    return least + static_cast<double>(best - costs.begin()) +
           0.5 * (before - after) / (before - 2 * here + after);
  }
  static constexpr int kHalf = 8;  ///< half a window [pixels]

 private:
  static std::vector<double> grey(std::span<const std::uint8_t> rgb) {
    std::vector<double> out;
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
      out.push_back(rgb[i] + rgb[i + 1] + rgb[i + 2]);
    return out;
  }
  double cost(int x, int y, int d) const {
    double sum = 0;
    for (int v = -kHalf; v <= kHalf; ++v)
      for (int u = -kHalf; u <= kHalf; ++u) {
        const auto row = static_cast<std::size_t>((y + v) * width_);
        const double e = left_[row + static_cast<std::size_t>(x + u)] -
                         right_[row + static_cast<std::size_t>(x + u - d)];
        sum += e * e;
      }
    return sum;
  }
  std::vector<double> left_, right_;
  int width_;
};

TEST(StereoCamera, GivesDepthByDisparityWithinOnePercent) {
  constexpr int kWidth = 480, kHeight = 320;
  device::Device device;
  const auto world =
      world_of(scene_of(mast(camera("pair", "navvy:stereo", kWidth, kHeight,
                                    "<navvy:baseline_m>0.25</navvy:baseline_m>") +
                             camera("depth", "depth_camera", kWidth, kHeight)),
                        "<hills><height_m>0.3</height_m><wavelength_m>6</wavelength_m></hills>"),
               device);
  const Matcher matcher(world->arrays().view("mast/pair/left").values<std::uint8_t>(),
                        world->arrays().view("mast/pair/right").values<std::uint8_t>(), kWidth);
  const auto depths = world->arrays().view("mast/depth/depth").values<float>();
  const double focal = 0.5 * kWidth / std::tan(0.5);
  int count = 0, within = 0;
  double sum = 0;
  for (int y = 24; y < kHeight - 24; y += 16)
    for (int x = 80; x < kWidth - 24; x += 16) {
      const double truth = depths[static_cast<std::size_t>(y * kWidth + x)];
      if (!std::isfinite(truth)) continue;
      const double d = matcher.disparity(x, y, 10, 60);
      if (d < 0) continue;
      const double error = focal * 0.25 / d / truth - 1;
      sum += error;
      ++count;
      within += std::abs(error) < 0.01 ? 1 : 0;
    }
  ASSERT_GT(count, 300);
  EXPECT_LT(std::abs(sum / count), 0.002);
  EXPECT_GT(within, 0.95 * count) << within << " of " << count;
}

TEST(PictureScene, SeveralDrawTheSamePictureInTurn) {
  device::Device device;
  const auto with_box = world_of(scene_of(mast("") + red_box()), device),
             without = world_of(scene_of(mast("")), device);
  const Pose X_WS = make_pose(0, 0, 3, 0, 0.8, 0);
  const auto draw = [&](PictureScene& pictures) { return pictures.draw(X_WS, 96, 64, 1).rgb; };
  auto first = std::make_unique<PictureScene>(*with_box);
  PictureScene second(*without);
  const auto box = draw(*first), empty = draw(second);
  EXPECT_NE(box, empty);
  EXPECT_EQ(draw(*first), box);
  EXPECT_EQ(draw(second), empty);
  // One that ends takes nothing of the others with it.
  first.reset();
  EXPECT_EQ(draw(second), empty);
  PictureScene third(*with_box);
  EXPECT_EQ(draw(third), box);
  EXPECT_EQ(draw(second), empty);
}

}  // namespace
}  // namespace navvy::sensor
