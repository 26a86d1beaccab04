// SPDX-License-Identifier: Apache-2.0
// Pictures of small scenes, checked pixel by pixel. All of these fail if functions that Coin
// fetches belong to an OpenGL other than OSMesa (see src/render/gl_shim.cpp).
#include "render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "core/stopwatch.h"
#include "folder.h"
#include "paths.h"
#include "render/shading.h"
#include "trench_scene.h"

namespace navvy::render {
namespace {

constexpr int kWidth = 320, kHeight = 200;

scene::FrameCamera small_camera(const Vec3& eye, const Vec3& target) {
  return look_from(eye, target, kWidth, kHeight);
}

/// Returns column and row of a point of W in the picture of `camera`.
Vec2 project(const scene::FrameCamera& camera, const Vec3& p) {
  const Vec3 c = camera.X_WC.inverse() * p;
  const double scale = 0.5 * camera.width / std::tan(0.5 * camera.fov);
  return {0.5 * camera.width + scale * c.x() / -c.z(),
          0.5 * camera.height - scale * c.y() / -c.z()};
}

int changed_pixels(const Image& a, const Image& b, int tolerance = 12) {
  int changed = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    int most = 0;
    for (std::size_t k = 0; k < 3; ++k)
      most = std::max(most, std::abs(int{a.rgb[i + k]} - int{b.rgb[i + k]}));
    changed += most > tolerance ? 1 : 0;
  }
  return changed;
}

bool is_red(const std::uint8_t* p) { return p[0] > 2 * p[1] && p[0] > 2 * p[2] && p[0] > 60; }

scene::Visual red_visual(scene::Geometry::Kind kind) {
  scene::Visual visual;
  visual.geometry.kind = kind;
  visual.geometry.radius = 0.4;
  visual.geometry.length = 0.8;
  visual.geometry.size = Vec3(0.8, 0.8, 0.8);
  visual.color = {0.9f, 0.05f, 0.05f, 1};
  return visual;
}

class RendererTest : public ::testing::Test {
 protected:
  void SetUp() override { make_ground(frame_.ground, 96, 96, 0.1); }

  scene::Frame frame_;
  scene::FrameCamera camera_ = small_camera({3.5, -4, 3}, {0, 0, 0});
};

TEST_F(RendererTest, SkyIsAtTheTopAndGroundAtTheBottom) {
  Renderer renderer;
  const Image image = renderer.render(frame_, small_camera({0, -6, 1.5}, {0, 0, 1.5}));
  const std::uint8_t* top = image.pixel(kWidth / 2, 3);
  const std::uint8_t* bottom = image.pixel(kWidth / 2, kHeight - 4);
  EXPECT_GT(top[2], top[0]) << "sky is blue";
  EXPECT_GT(bottom[0], bottom[2] + 10) << "soil is brown";
}

TEST_F(RendererTest, DrawsEveryColumnOfAHeightfield) {
  RenderOptions options;
  options.surroundings = false;
  Renderer renderer(options);
  DepthImage depth;
  renderer.render(frame_, small_camera({0, 0, 8}, {0, 0, 0}), &depth);
  // From 8 m above, 50 degrees see 7.5 m x 4.7 m of the 9.6 m square: ground in every pixel, at 8 m
  // except for its unevenness of 0.02 m and the precision of a 24-bit depth buffer.
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(depth.at(x, y), 8.0, 0.05) << x << ", " << y;
  EXPECT_GE(renderer.stats().ground_triangles, 2000);
}

bool is_green(const std::uint8_t* p) { return p[1] > 2 * p[0] && p[1] > 2 * p[2] && p[1] > 60; }

int green_pixels(const Image& image) {
  int out = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) out += is_green(&image.rgb[i]) ? 1 : 0;
  return out;
}

TEST_F(RendererTest, DrawsLinesWhereTheyAreAndHidesThemBehindGroundIfAsked) {
  Renderer renderer;
  const Image without = renderer.render(frame_, camera_);
  EXPECT_EQ(green_pixels(without), 0);
  const scene::Color green{0, 1, 0, 1};
  const Vec3 from(-1, 0, 0.5), to(1, 0.5, 0.5);
  frame_.overlay.lines = {{{from, to}, green, 2, false}};
  const Image with = renderer.render(frame_, camera_);
  const double length = (project(camera_, from) - project(camera_, to)).norm();
  EXPECT_NEAR(green_pixels(with), 2 * length, 0.5 * length);
  const Vec2 middle = project(camera_, 0.5 * (from + to));
  int near = 0;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx)
      near +=
          is_green(with.pixel(static_cast<int>(middle.x()) + dx, static_cast<int>(middle.y()) + dy))
              ? 1
              : 0;
  EXPECT_GE(near, 4);
  // Below the ground: seen through it unless it hides the line.
  frame_.overlay.lines = {{{Vec3(-1, 0, -0.5), Vec3(1, 0, -0.5)}, green, 2, false}};
  EXPECT_GT(green_pixels(renderer.render(frame_, camera_)), 50);
  frame_.overlay.lines.front().hidden = true;
  EXPECT_EQ(green_pixels(renderer.render(frame_, camera_)), 0);
  frame_.overlay = {};
  EXPECT_EQ(renderer.render(frame_, camera_).rgb, without.rgb);
}

TEST_F(RendererTest, DrawsTextAtItsPlaceAndTheCaptionAtTheUpperEdge) {
  Renderer renderer;
  const Image without = renderer.render(frame_, camera_);
  frame_.overlay.labels = {{Vec3(0, 0, 0.2), "12.5 kN", {0, 1, 0, 1}}};
  const Image labelled = renderer.render(frame_, camera_);
  EXPECT_GT(green_pixels(labelled), 40);
  const Vec2 place = project(camera_, {0, 0, 0.2});
  int nearby = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (is_green(labelled.pixel(x, y)) && std::abs(x - place.x()) < 80 &&
          std::abs(y - place.y()) < 20)
        ++nearby;
  EXPECT_EQ(nearby, green_pixels(labelled));
  // A label behind the camera is not mirrored into the picture.
  frame_.overlay.labels.front().p_W = Vec3(7, -8, 6);
  EXPECT_EQ(green_pixels(renderer.render(frame_, camera_)), 0);
  frame_.overlay = {};
  frame_.overlay.caption = "trench  3.0 s";
  const Image titled = renderer.render(frame_, camera_);
  int changed = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (titled.pixel(x, y)[0] != without.pixel(x, y)[0]) {
        EXPECT_LT(y, 30);
        ++changed;
      }
  EXPECT_GT(changed, 100);
}

TEST_F(RendererTest, ColorsCutAndFill) {
  Renderer renderer;
  scene::FrameGround& ground = frame_.ground;
  const auto set = [&](int x0, float change) {
    for (int iy = 40; iy < 56; ++iy)
      for (int ix = x0; ix < x0 + 12; ++ix) {
        const std::size_t i = static_cast<std::size_t>(iy * ground.nx + ix);
        ground.height[i] += change;
        ground.change[i] += change;
      }
  };
  set(30, -0.4f);
  set(54, 0.4f);
  ground.cut_fill = 0.5;
  const scene::FrameCamera above = small_camera({0, 0, 8}, {0, 0, 0});
  const Image image = renderer.render(frame_, above);
  const auto at = [&](double x, double y) {
    const Vec2 p = project(above, {x, y, 0});
    return image.pixel(static_cast<int>(p.x()), static_cast<int>(p.y()));
  };
  EXPECT_TRUE(is_red(at(-1.2, 0)));
  const std::uint8_t* fill = at(1.2, 0);
  EXPECT_GT(fill[2], 2 * fill[0]) << "fill is blue";
  const std::uint8_t* untouched = at(0, 2);
  EXPECT_GT(untouched[0], untouched[2]) << "soil is brown";
}

TEST_F(RendererTest, DugCellsChangePixelsWhereTheyAre) {
  Renderer renderer;
  const Image before = renderer.render(frame_, camera_);
  scene::FrameGround& ground = frame_.ground;
  for (int iy = 40; iy < 56; ++iy)
    for (int ix = 40; ix < 56; ++ix) {
      const std::size_t i = static_cast<std::size_t>(iy * ground.nx + ix);
      ground.height[i] -= 0.5f;
      ground.change[i] -= 0.5f;
    }
  ground.changed = {{40, 40, 56, 56}};
  ++ground.revision;
  const Image after = renderer.render(frame_, camera_);
  EXPECT_GT(changed_pixels(before, after), 1500);
  const Vec2 corner = project(camera_, Vec3(-3, 3, 0));
  const int x = static_cast<int>(corner.x()), y = static_cast<int>(corner.y());
  ASSERT_TRUE(x >= 0 && y >= 0 && x < kWidth && y < kHeight);
  EXPECT_EQ(before.pixel(x, y)[0], after.pixel(x, y)[0]) << "pixels far from the cut are unchanged";
}

TEST_F(RendererTest, ADirtyRectangleGivesTheSamePictureAsAWholeUpdate) {
  Renderer updated;
  updated.render(frame_, camera_);
  dig_trench(frame_.ground, -2, 0.3);
  EXPECT_EQ(updated.render(frame_, camera_).rgb, Renderer().render(frame_, camera_).rgb);
}

TEST_F(RendererTest, SeveralRectanglesGiveTheSamePictureAsAWholeUpdate) {
  Renderer updated;
  updated.render(frame_, camera_);
  scene::FrameGround& ground = frame_.ground;
  // Two that share shadows, one far away, one single column and one beyond the edge.
  ground.changed = {
      {40, 40, 50, 44}, {52, 41, 60, 47}, {5, 8, 9, 20}, {ground.nx - 3, 2, ground.nx - 2, 3}};
  for (const scene::FrameRect& rect : ground.changed)
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix) {
        const auto i = static_cast<std::size_t>(iy * ground.nx + ix);
        ground.height[i] -= 0.4f;
        ground.change[i] -= 0.4f;
      }
  ground.changed.push_back({ground.nx, 0, ground.nx + 5, 5});
  ++ground.revision;
  EXPECT_EQ(updated.render(frame_, camera_).rgb, Renderer().render(frame_, camera_).rgb);
}

TEST_F(RendererTest, ComparesHeightsWhenARevisionWasMissed) {
  Renderer updated;
  updated.render(frame_, camera_);
  dig_trench(frame_.ground, -2, 0.3);
  frame_.ground.revision += 5;
  frame_.ground.changed.clear();
  EXPECT_EQ(updated.render(frame_, camera_).rgb, Renderer().render(frame_, camera_).rgb);
}

TEST_F(RendererTest, ThousandsOfParticlesInTheAirChangePixels) {
  Renderer renderer;
  const Image before = renderer.render(frame_, camera_);
  add_soil(frame_.particles, {-0.5, -0.5, 0.5}, {0.5, 0.5, 1.0}, 0.1);
  ASSERT_GT(frame_.particles.position.size() / 3, 3000u);
  const Image after = renderer.render(frame_, camera_);
  EXPECT_GT(changed_pixels(before, after), 1500);
  EXPECT_GT(renderer.stats().soil_triangles, 1000);
  const Vec2 at = project(camera_, Vec3(0, 0, 1.0));
  const std::uint8_t* p = after.pixel(static_cast<int>(at.x()), static_cast<int>(at.y()));
  EXPECT_GT(p[0], p[2]) << "soil is brown";
}

TEST_F(RendererTest, ParticlesOnTheGroundAreNoLumps) {
  frame_.particles.position = {0, 0, 0.03f, 0.5f, 0.2f, 0.04f, -0.4f, 0.3f, 0.02f};
  Renderer renderer;
  renderer.render(frame_, camera_);
  EXPECT_EQ(renderer.stats().particles_drawn, 0);
  for (std::size_t i = 2; i < 9; i += 3) frame_.particles.position[i] += 0.5f;
  renderer.render(frame_, camera_);
  EXPECT_EQ(renderer.stats().particles_drawn, 3);
}

/// Heaps soil on the middle of a level ground of 96 x 96 columns: as particles where x is below
/// `border` [m], as columns beyond.
void heap_up(scene::Frame& frame, double border) {
  scene::FrameGround& ground = frame.ground;
  const auto heap = [](double x, double y) {
    return 0.5 * smooth_step(1.6f, 0.2f, static_cast<float>(std::hypot(x, y)));
  };
  ground.top = ground.height;
  for (int iy = 0; iy < ground.ny; ++iy)
    for (int ix = 0; ix < ground.nx; ++ix) {
      const auto i = static_cast<std::size_t>(iy * ground.nx + ix);
      const double x = ground.origin.x() + (ix + 0.5) * ground.cell,
                   y = ground.origin.y() + (iy + 0.5) * ground.cell;
      const auto rise = static_cast<float>(heap(x, y));
      ground.top[i] += rise;
      if (x < border) continue;
      ground.height[i] += rise;
      ground.change[i] += rise;
    }
  scene::FrameParticles all;
  add_soil(all, {-1.6, -1.6, 0.02}, {1.6, 1.6, 0.6}, ground.cell);
  frame.particles.radius = all.radius;
  for (std::size_t i = 0; i < all.position.size(); i += 3) {
    const float* p = &all.position[i];
    if (p[0] > border || p[2] > heap(p[0], p[1])) continue;
    frame.particles.position.insert(frame.particles.position.end(), p, p + 3);
    frame.particles.id.push_back(all.id[i / 3]);
  }
}

TEST_F(RendererTest, SoilThatComesToRestLooksAsBefore) {
  scene::Frame moving = frame_, resting = frame_;
  heap_up(moving, 9);
  heap_up(resting, 0.4);
  Renderer renderer;
  const Image before = renderer.render(moving, camera_);
  ASSERT_GT(renderer.stats().soil_triangles, 3000);
  const Image after = Renderer().render(resting, camera_);
  // Four grey levels are hard to see; soil that settles by some millimetres moves its grain by a
  // pixel.
  EXPECT_LT(changed_pixels(before, after, 4), 0.01 * kWidth * kHeight);
}

TEST_F(RendererTest, TheContentOfABucketChangesPixels) {
  // An open box stands for the bucket: its content must be seen inside.
  std::vector<scene::Visual> plates(5, red_visual(scene::Geometry::Kind::kBox));
  const Vec3 at[5] = {{0, 0, 1.0}, {0.5, 0, 1.3}, {-0.5, 0, 1.3}, {0, 0.5, 1.3}, {0, -0.5, 1.3}};
  for (std::size_t i = 0; i < 5; ++i) {
    plates[i].geometry.size = i == 0  ? Vec3(1, 1, 0.02)
                              : i < 3 ? Vec3(0.02, 1, 0.6)
                                      : Vec3(1, 0.02, 0.6);
    frame_.shapes.push_back({&plates[i], make_pose(at[i].x(), at[i].y(), at[i].z())});
  }
  const scene::FrameCamera above = small_camera({1, -1.5, 4.5}, {0, 0, 1.2});
  Renderer renderer;
  const Image empty = renderer.render(frame_, above);
  add_soil(frame_.particles, {-0.45, -0.45, 1.05}, {0.45, 0.45, 1.45}, 0.1);
  const Image full = renderer.render(frame_, above);
  const Vec2 middle = project(above, Vec3(0, 0, 1.4));
  const int x = static_cast<int>(middle.x()), y = static_cast<int>(middle.y());
  EXPECT_TRUE(is_red(empty.pixel(x, y)));
  EXPECT_FALSE(is_red(full.pixel(x, y)));
  EXPECT_GT(changed_pixels(empty, full), 800);
}

TEST_F(RendererTest, NoParticleReachesThroughAPlate) {
  scene::Visual plate = red_visual(scene::Geometry::Kind::kBox);
  plate.geometry.size = Vec3(0.02, 2, 2);
  frame_.shapes.push_back({&plate, make_pose(0, 0, 1.5)});
  const scene::FrameCamera from_behind = small_camera({-4, 0, 1.5}, {0, 0, 1.5});
  Renderer renderer;
  const Image bare = renderer.render(frame_, from_behind);
  // Single particles against the plate's other face.
  for (float y = -0.6f; y < 0.6f; y += 0.15f)
    for (float z = 1; z < 2; z += 0.15f)
      frame_.particles.position.insert(frame_.particles.position.end(), {0.015f, y, z});
  EXPECT_GT(changed_pixels(bare, renderer.render(frame_, from_behind)), 20)
      << "particles of full size would be visible";
  for (std::size_t i = 0; i < frame_.particles.position.size(); i += 3)
    frame_.particles.clearance.push_back(std::max(0.0f, frame_.particles.position[i] - 0.01f));
  EXPECT_EQ(changed_pixels(bare, renderer.render(frame_, from_behind)), 0);
}

TEST_F(RendererTest, BodiesAreDrawnAtTheirPose) {
  Renderer renderer;
  for (const auto kind : {scene::Geometry::Kind::kSphere, scene::Geometry::Kind::kBox,
                          scene::Geometry::Kind::kCylinder}) {
    const scene::Visual visual = red_visual(kind);
    for (const Vec3& p : {Vec3(-1, -0.5, 0.8), Vec3(1, 1, 1.2)}) {
      frame_.shapes = {{&visual, make_pose(p.x(), p.y(), p.z(), 0, 0, 0.4)}};
      const Image image = renderer.render(frame_, camera_);
      double sum_x = 0, sum_y = 0;
      int n = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          if (is_red(image.pixel(x, y))) {
            sum_x += x + 0.5;
            sum_y += y + 0.5;
            ++n;
          }
      ASSERT_GT(n, 300);
      const Vec2 expected = project(camera_, p);
      // The centre of a body's outline differs from its projected centre by perspective: under 3
      // pixels here.
      EXPECT_NEAR(sum_x / n, expected.x(), 3);
      EXPECT_NEAR(sum_y / n, expected.y(), 3);
    }
  }
}

TEST_F(RendererTest, CapsulesAndConesHaveTheirOutline) {
  // From the side and from a distance, so that perspective takes less than a pixel; widths of the
  // picture's rows in metres.
  const Vec3 at(0, 0, 3);
  const scene::FrameCamera side = small_camera({0, -6, 3}, at);
  Renderer renderer;
  const auto width = [&](scene::Geometry::Kind kind, double z) {
    const scene::Visual visual = red_visual(kind);
    frame_.shapes = {{&visual, make_pose(at.x(), at.y(), at.z())}};
    const Image image = renderer.render(frame_, side);
    const Vec2 row = project(side, at + Vec3(0, 0, z));
    int n = 0;
    for (int x = 0; x < kWidth; ++x) n += is_red(image.pixel(x, static_cast<int>(row.y()))) ? 1 : 0;
    return n / (project(side, at + Vec3(1, 0, z)).x() - row.x());
  };
  using Kind = scene::Geometry::Kind;
  constexpr double kPixels = 0.06;  // [m] two, and the corners of the polygons
  for (const double z : {-0.37, 0.0, 0.37})
    EXPECT_NEAR(width(Kind::kCapsule, z), 0.8, kPixels) << z;
  for (const double z : {-0.7, 0.7})
    EXPECT_NEAR(width(Kind::kCapsule, z), 2 * std::sqrt(0.16 - 0.09), kPixels) << z;
  for (const double z : {-0.35, 0.0, 0.3})
    EXPECT_NEAR(width(Kind::kCone, z), 0.4 - z, kPixels) << z;
  for (const double z : {-0.85, 0.85}) EXPECT_EQ(width(Kind::kCapsule, z), 0) << z;
  for (const double z : {-0.45, 0.45}) EXPECT_EQ(width(Kind::kCone, z), 0) << z;
}

TEST_F(RendererTest, DrawsLargeMeshFilesCompletely) {
  // Coin passes meshes of this size to OpenGL in arrays, through functions it fetches by name.
  const test::Folder folder;
  const std::string file = folder / "grid.obj";
  std::ofstream out(file);
  constexpr int kSide = 65;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i)
      out << "v " << i / 64.0 - 0.5 << ' ' << j / 64.0 - 0.5 << " 0\n";
  for (int j = 0; j + 1 < kSide; ++j)
    for (int i = 0; i + 1 < kSide; ++i) {
      const int a = j * kSide + i + 1;
      out << "f " << a << ' ' << a + 1 << ' ' << a + kSide + 1 << ' ' << a + kSide << '\n';
    }
  out.close();
  scene::Visual visual = red_visual(scene::Geometry::Kind::kMesh);
  visual.geometry.mesh_file = file;
  visual.geometry.scale = Vec3(2, 2, 1);
  frame_.shapes = {{&visual, make_pose(0, 0, 1)}};
  const scene::FrameCamera above = small_camera({0, 0, 6}, {0, 0, 0});
  Renderer renderer;
  const Image image = renderer.render(frame_, above);
  for (double x = -0.95; x < 1; x += 0.1)
    for (double y = -0.95; y < 1; y += 0.1) {
      const Vec2 at = project(above, Vec3(x, y, 1));
      ASSERT_TRUE(is_red(image.pixel(static_cast<int>(at.x()), static_cast<int>(at.y()))))
          << x << ", " << y;
    }
}

TEST_F(RendererTest, CylindersReachFromPinToPin) {
  frame_.cylinders.push_back({Vec3(-1, 0, 1), Vec3(1, 0, 1), 0.15, 1.0});
  const scene::FrameCamera side = small_camera({0, -5, 1}, {0, 0, 1});
  Renderer renderer;
  DepthImage depth;
  renderer.render(frame_, side, &depth);
  const auto depth_at = [&](double x) {
    const Vec2 at = project(side, Vec3(x, 0, 1));
    return depth.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
  };
  EXPECT_NEAR(depth_at(-0.5), 4.85, 0.03) << "the barrel's radius before the axis";
  EXPECT_NEAR(depth_at(0.5), 5 - 0.55 * 0.15, 0.03) << "the rod is thinner";
  EXPECT_GT(depth_at(1.2), 6) << "nothing beyond the pin";
}

TEST_F(RendererTest, MachinesThrowAShadow) {
  const scene::Visual visual = red_visual(scene::Geometry::Kind::kBox);
  Renderer renderer;
  const Image before = renderer.render(frame_, camera_);
  frame_.shapes = {{&visual, make_pose(0, 0, 1.2)}};
  const Image after = renderer.render(frame_, camera_);
  // The default light travels along (-0.5, 0.35, -0.8).
  const Vec2 at = project(camera_, Vec3(0, 0, 1.2) + 1.5 * Vec3(-0.5, 0.35, -0.8));
  const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
  EXPECT_LT(after.pixel(x, y)[0], 0.75 * before.pixel(x, y)[0]);
}

TEST_F(RendererTest, BodiesThrowShadowsOnBodiesBelowThem) {
  scene::Visual plate = red_visual(scene::Geometry::Kind::kBox);
  plate.geometry.size = Vec3(4, 4, 0.1);
  const scene::Visual box = red_visual(scene::Geometry::Kind::kBox);
  // The default light travels along (-0.5, 0.35, -0.8).
  const Vec3 shaded = Vec3(0, 0, 1) + 0.75 * Vec3(-0.5, 0.35, -0.8) / 0.8;
  const Vec2 at = project(camera_, Vec3(shaded.x(), shaded.y(), 0.25));
  const Vec2 beside = project(camera_, Vec3(1, 0.5, 0.25));
  const auto red = [](const Image& image, const Vec2& p) {
    return static_cast<int>(image.pixel(static_cast<int>(p.x()), static_cast<int>(p.y()))[0]);
  };
  Renderer renderer;
  frame_.shapes = {{&plate, make_pose(0, 0, 0.2)}};
  const Image alone = renderer.render(frame_, camera_);
  EXPECT_NEAR(red(alone, at), red(alone, beside), 3) << "the plate is lit evenly";
  frame_.shapes.push_back({&box, make_pose(0, 0, 1.4)});
  const Image below = renderer.render(frame_, camera_);
  EXPECT_LT(red(below, at), 0.8 * red(alone, at));
  EXPECT_NEAR(red(below, beside), red(alone, beside), 3) << "no shadow where nothing is above";
  // A box throws no shadow on its own lit side.
  const Vec2 side = project(camera_, Vec3(0.1, -0.4, 1.2));
  EXPECT_GT(red(below, side), red(below, at));
}

TEST_F(RendererTest, TheSameFrameGivesTheSameBytes) {
  TrenchScene scene;
  make_trench_scene(scene, navvy::source_dir() + "/vehicles/ew180/meshes", 200);
  const scene::FrameCamera camera = small_camera({9, -7, 4}, {1.5, 0, 1});
  Renderer renderer;
  const Image first = renderer.render(scene.frame, camera);
  EXPECT_EQ(first.rgb, renderer.render(scene.frame, camera).rgb);
  EXPECT_EQ(first.rgb, Renderer().render(scene.frame, camera).rgb);
}

TEST_F(RendererTest, PictureSizesMayAlternate) {
  Renderer renderer;
  const Image small = renderer.render(frame_, camera_);
  scene::FrameCamera large = camera_;
  large.width = 640;
  large.height = 400;
  EXPECT_EQ(renderer.render(frame_, large).rgb.size(), 3u * 640u * 400u);
  EXPECT_EQ(renderer.render(frame_, camera_).rgb, small.rgb);
}

TEST_F(RendererTest, RefusesImpossibleInput) {
  Renderer renderer;
  scene::FrameCamera none = camera_;
  none.width = 0;
  EXPECT_THROW(renderer.render(frame_, none), Error);
  scene::Visual visual = red_visual(scene::Geometry::Kind::kMesh);
  visual.geometry.mesh_file = "/nonexistent/mesh.obj";
  frame_.shapes = {{&visual, Pose::Identity()}};
  EXPECT_THROW(renderer.render(frame_, camera_), FileError);
  frame_.shapes.clear();
  frame_.ground.change.pop_back();
  EXPECT_THROW(renderer.render(frame_, camera_), Error);
}

TEST_F(RendererTest, ToleratesNonFiniteHeightsAndParticles) {
  frame_.ground.height[5000] = std::numeric_limits<float>::quiet_NaN();
  add_soil(frame_.particles, {0, 0, 0.5}, {0.3, 0.3, 0.8}, 0.1);
  frame_.particles.position[7] = std::numeric_limits<float>::infinity();
  Renderer renderer;
  EXPECT_EQ(renderer.render(frame_, camera_).rgb.size(), 3u * kWidth * kHeight);
}

TEST_F(RendererTest, AFrameWithoutGroundIsSky) {
  Renderer renderer;
  const Image image = renderer.render(scene::Frame{}, small_camera({0, -6, 1.5}, {0, 0, 3}));
  EXPECT_GT(image.pixel(5, 5)[2], image.pixel(5, 5)[0]);
}

TEST_F(RendererTest, PrintsTheTimeOfALargeSite) {
  scene::Frame site;
  make_ground(site.ground, 1024, 1024, 0.1);
  dig_trench(site.ground, 3, 0);
  Renderer renderer;
  const scene::FrameCamera camera = look_from({12, -10, 6}, {0, 0, 0});
  renderer.render(site, camera);
  double least = 1e9;
  for (int i = 0; i < 3; ++i) {
    const Stopwatch watch;
    renderer.render(site, camera);
    least = std::min(least, 1e3 * watch.seconds());
  }
  std::printf(
      "1280 x 720 over 1024 x 1024 columns: %.1f ms a picture, %d ground triangles (wanted: 60 "
      "ms)\n",
      least, renderer.stats().ground_triangles);
  // The budget holds except for skirts, walls and the surroundings.
  EXPECT_LT(renderer.stats().ground_triangles, 130000);
  EXPECT_EQ(renderer.stats().tiles_rebuilt, 0) << "without a change no tile is rebuilt";
}

TEST_F(RendererTest, PrintsTheTimeOfTheSurfaceOfLooseSoil) {
  // 11 k particles as a heap in front of a bucket, and the same 30 m apart.
  for (const double apart : {0.0, 30.0}) {
    scene::Frame site;
    make_ground(site.ground, 512, 512, 0.1);
    add_soil(site.particles, {-0.9, -0.6, 0}, {0.9, 0.6, apart > 0 ? 0.3 : 0.62}, 0.1);
    if (apart > 0) add_soil(site.particles, {-0.9, apart - 0.6, 0}, {0.9, apart + 0.6, 0.3}, 0.1);
    Renderer renderer;
    const scene::FrameCamera camera = look_from({12, -10, 6}, {0, 0, 0});
    double least = 1e9;
    for (int i = 0; i < 5; ++i) {
      renderer.render(site, camera);
      least = std::min(least, renderer.stats().soil_ms);
    }
    std::printf("surface of %zu particles%s: %.1f ms, %d triangles (wanted: %d ms)\n",
                site.particles.position.size() / 3, apart > 0 ? " at two places" : "", least,
                renderer.stats().soil_triangles, apart > 0 ? 8 : 3);
    EXPECT_GT(renderer.stats().soil_triangles, 1000);
  }
}

}  // namespace
}  // namespace navvy::render
