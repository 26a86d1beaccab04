// SPDX-License-Identifier: Apache-2.0
// The surface of loose soil: where it is, where it ends, and what is too little for one.
#include "render/soil_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "trench_scene.h"

namespace navvy::render {
namespace {

constexpr double kCell = 0.1;

/// A level ground of 4.8 m a side at z = 0 with particles.
class SoilSurfaceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    make_ground(frame_.ground, 48, 48, kCell);
    std::fill(frame_.ground.height.begin(), frame_.ground.height.end(), 0.0f);
    lighting_ = make_lighting({});
    shadows_.begin(lighting_, Vec3f::Zero(), Vec3f::Ones());
  }

  const Mesh& build() {
    ground_.update(frame_.ground, lighting_);
    return soil_.build(frame_, lighting_, shadows_, ground_);
  }

  /// Returns the highest vertex within 5 cm of (x, y); -1 without any.
  static double top_at(const Mesh& mesh, double x, double y) {
    double top = -1;
    for (const Vertex& v : mesh.vertices)
      if (std::hypot(v.x - x, v.y - y) < 0.05) top = std::max(top, static_cast<double>(v.z));
    return top;
  }

  scene::Frame frame_;
  Lighting lighting_;
  ShadowMap shadows_;
  GroundSurface ground_;
  SoilSurface soil_;
};

TEST_F(SoilSurfaceTest, LiesOnTheOutermostParticles) {
  // Particles fill the box to half their distance beyond their places: to z = 1.025.
  add_soil(frame_.particles, {-0.5, -0.5, 0.6}, {0.5, 0.5, 1.02}, kCell);
  const Mesh& mesh = build();
  ASSERT_GT(mesh.vertices.size(), 500u);
  double sum = 0;
  int places = 0;
  for (double x = -0.3; x < 0.35; x += 0.1)
    for (double y = -0.3; y < 0.35; y += 0.1, ++places) {
      const double off = top_at(mesh, x, y) - 1.025;
      // Uneven as soil is.
      EXPECT_LT(std::abs(off), 0.5 * kCell) << x << ", " << y;
      sum += off;
    }
  EXPECT_NEAR(sum / places, 0, 0.25 * kCell);
  const std::vector<std::uint8_t>& lone = soil_.lone();
  EXPECT_LT(std::count(lone.begin(), lone.end(), 1), 0.02 * static_cast<double>(lone.size()));
}

TEST_F(SoilSurfaceTest, IsClosedInTheAir) {
  add_soil(frame_.particles, {-0.3, -0.3, 1.0}, {0.3, 0.3, 1.5}, kCell);
  const Mesh& mesh = build();
  // Each edge belongs to two triangles, walked in opposite directions.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto* list : {&mesh.indices, &mesh.walls})
    for (std::size_t i = 0; i + 2 < list->size(); i += 3)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = (*list)[i + k], b = (*list)[i + (k + 1) % 3];
        edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      }
  ASSERT_GT(edges.size(), 1000u);
  for (const auto& [edge, sum] : edges) ASSERT_EQ(sum, 0) << edge.first << " to " << edge.second;
}

TEST_F(SoilSurfaceTest, ContinuesLevelIntoTheGroundAroundIt) {
  // The upper three cells of 1 m x 1 m of the ground are active.
  for (int iy = 19; iy < 29; ++iy)
    for (int ix = 19; ix < 29; ++ix)
      frame_.ground.height[static_cast<std::size_t>(ix + 48 * iy)] = -0.3f;
  add_soil(frame_.particles, {-0.475, -0.475, -0.275}, {0.5, 0.5, 0.0}, kCell);
  const Mesh& mesh = build();
  double squares = 0, most = 0;
  int count = 0;
  for (const Vertex& v : mesh.vertices) {
    if (std::abs(v.x) > 0.6 || std::abs(v.y) > 0.6) continue;
    most = std::max(most, std::abs(static_cast<double>(v.z)));
    squares += static_cast<double>(v.z) * static_cast<double>(v.z);
    ++count;
  }
  ASSERT_GT(count, 300);
  // No step and no gap at the border: lumps would stand off by a cell.
  EXPECT_LT(std::sqrt(squares / count), 0.15 * kCell);
  EXPECT_LT(most, 0.5 * kCell);
}

TEST_F(SoilSurfaceTest, HidesTheColumnsBelowItAlsoAtItsSides) {
  // A block of active soil of 1 m x 1 m x 1 m, whose sides are steep.
  frame_.ground.top = frame_.ground.height;
  for (int iy = 19; iy < 29; ++iy)
    for (int ix = 19; ix < 29; ++ix) frame_.ground.top[static_cast<std::size_t>(ix + 48 * iy)] = 1;
  ground_.update(frame_.ground, lighting_);
  EXPECT_GT(ground_.height(24, 24), 0.9) << "close below the soil";
  EXPECT_LT(ground_.height(24, 24), 1.0);
  // Smoothing makes the steps two columns wide.
  for (const int ix : {16, 17, 18, 19}) EXPECT_LT(ground_.height(ix, 24), 0.5) << ix;
}

TEST_F(SoilSurfaceTest, StaysOnItsSideOfAPlate) {
  // A plate whose face is at x = 0, and soil that touches it.
  add_soil(frame_.particles, {0.02, -0.4, 1.0}, {0.5, 0.4, 1.6}, kCell);
  const auto farthest = [&] {
    float least = 1;
    for (const Vertex& v : build().vertices) least = std::min(least, v.x);
    return least;
  };
  EXPECT_LT(farthest(), 0) << "without the plate";
  for (std::size_t i = 0; i < frame_.particles.position.size(); i += 3) {
    frame_.particles.clearance.push_back(std::max(0.0f, frame_.particles.position[i]));
    frame_.particles.away.insert(frame_.particles.away.end(), {1, 0, 0});
  }
  EXPECT_GT(farthest(), -1e-5f);
}

TEST_F(SoilSurfaceTest, LeavesSingleParticlesToLumps) {
  add_soil(frame_.particles, {-0.5, -0.5, 1.0}, {0.5, 0.5, 2.0}, 0.8);
  const Mesh& mesh = build();
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_EQ(std::count(soil_.lone().begin(), soil_.lone().end(), 0), 0);
}

TEST_F(SoilSurfaceTest, IsTheSameInOnePieceAndBesideSoilFarAway) {
  add_soil(frame_.particles, {-0.3, -0.3, 0.5}, {0.3, 0.3, 0.9}, kCell);
  const std::size_t alone = build().vertices.size();
  add_soil(frame_.particles, {500, 500, 3}, {500.2, 500.2, 3.2}, kCell);
  // A grid over the whole site would not fit into memory.
  EXPECT_GT(build().vertices.size(), alone);
  EXPECT_LT(build().vertices.size(), 2 * alone);
}

TEST_F(SoilSurfaceTest, RefusesArraysOfAnotherSize) {
  add_soil(frame_.particles, {0, 0, 0.5}, {0.3, 0.3, 0.8}, kCell);
  frame_.particles.away.assign(3, 0);
  EXPECT_ANY_THROW(build());
}

}  // namespace
}  // namespace navvy::render
