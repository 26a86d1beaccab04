// SPDX-License-Identifier: Apache-2.0
#include "geometry/ray_tree.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "core/random.h"
#include "geometry/bodies.h"

namespace navvy::geometry {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 somewhere(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return Vec3(x, y, random.uniform(-size, size));
}

/// Returns the closest hit by testing every triangle.
std::optional<RayHit> by_force(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction,
                               double reach) {
  std::optional<RayHit> best;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TriangleMesh one;
    one.vertices = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    one.triangles = {{0, 1, 2}};
    const auto hit = RayTree(one).first_hit(origin, direction, reach);
    if (hit && (!best || hit->distance < best->distance))
      best = RayHit{static_cast<int>(t), hit->distance, mesh.area_vector(t).normalized()};
  }
  return best;
}

TEST(RayTree, FindsTheWallOfABoxFromOutsideAndFromInside) {
  const RayTree tree(make_box(Vec3(-1, -1, -1), Vec3(2, 2, 2)));
  const auto outside = tree.first_hit(Vec3(5, 0.2, 0.3), Vec3(-10, 0, 0));
  ASSERT_TRUE(outside);
  EXPECT_DOUBLE_EQ(outside->distance, 4);
  EXPECT_EQ(outside->normal, Vec3(1, 0, 0));
  const auto inside = tree.first_hit(Vec3(0, 0.2, 0.3), Vec3(0, 0, -1));
  ASSERT_TRUE(inside);
  EXPECT_DOUBLE_EQ(inside->distance, 1.3);
  EXPECT_EQ(inside->normal, Vec3(0, 0, -1)) << "the front faces outwards";
  EXPECT_FALSE(tree.first_hit(Vec3(5, 0.2, 0.3), Vec3(1, 0, 0)));
  EXPECT_FALSE(tree.first_hit(Vec3(5, 0.2, 0.3), Vec3(-1, 0, 0), 3.9));
  EXPECT_TRUE(tree.first_hit(Vec3(5, 0.2, 0.3), Vec3(-1, 0, 0), 4.0)) << "the reach limits hits";
}

TEST(RayTree, AgreesBitForBitWithATestOfEveryTriangle) {
  Random random(11);
  for (const double size : {0.02, 0.3, 2.0}) {  // specks, medium, a thicket
    TriangleMesh mesh;
    for (int t = 0; t < 500; ++t) {
      const Vec3 at = somewhere(random, 1);
      for (int i = 0; i < 3; ++i) mesh.vertices.push_back(at + somewhere(random, size));
      mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const RayTree tree(mesh);
    int hits = 0;
    for (int r = 0; r < 2000; ++r) {
      const Vec3 origin = somewhere(random, 3);
      const Vec3 direction = (somewhere(random, 1) - origin).normalized();
      const double reach = r % 3 == 0 ? 2 : kInfinity;
      const auto expected = by_force(mesh, origin, direction, reach);
      const auto found = tree.first_hit(origin, direction, reach);
      ASSERT_EQ(found.has_value(), expected.has_value()) << r;
      if (!found) continue;
      ++hits;
      EXPECT_EQ(found->triangle, expected->triangle);
      EXPECT_EQ(found->distance, expected->distance);
      EXPECT_EQ(found->normal, expected->normal);
    }
    EXPECT_GT(hits, 5);
  }
}

TEST(RayTree, MissesNoRayAtEdgesAndCornersOfAClosedBody) {
  const TriangleMesh sphere = make_ellipsoid(Vec3(1, 0.7, 1.3), 3);
  const RayTree tree(sphere);
  Random random(5);
  int rays = 0;
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 a = sphere.corner(t, i), b = sphere.corner(t, (i + 1) % 3);
      for (const double share : {0.0, 0.5, random.uniform()}) {
        const Vec3 origin = somewhere(random, 0.3);
        EXPECT_TRUE(tree.first_hit(origin, a + share * (b - a) - origin)) << t;
        ++rays;
      }
    }
  EXPECT_GT(rays, 4000);
}

TEST(RayTree, ReturnsTheLowestIndexOfEqualHits) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int i = 0; i < 40; ++i) mesh.triangles.push_back({0, 1, 2});
  const auto hit = RayTree(mesh).first_hit(Vec3(0.2, 0.2, 5), Vec3(0, 0, -1));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 0);
  // At a corner of a box three faces have the same distance.
  const TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
  const auto corner = RayTree(box).first_hit(Vec3(2, 2, 2), Vec3(-1, -1, -1));
  ASSERT_TRUE(corner);
  EXPECT_EQ(corner->triangle, by_force(box, Vec3(2, 2, 2), Vec3(-1, -1, -1), kInfinity)->triangle);
}

TEST(RayTree, HandlesRaysAlongTheAxesInThePlanesOfItsBoxes) {
  // A grid whose triangles, and so boxes, begin exactly where the rays run.
  TriangleMesh grid;
  for (int y = 0; y <= 8; ++y)
    for (int x = 0; x <= 8; ++x) grid.vertices.emplace_back(x, y, 0);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const int a = 9 * y + x;
      grid.triangles.push_back({a, a + 1, a + 10});
      grid.triangles.push_back({a, a + 10, a + 9});
    }
  const RayTree tree(grid);
  for (int y = 0; y <= 8; ++y)
    for (int x = 0; x <= 8; ++x) {
      const auto hit = tree.first_hit(Vec3(x, y, 3), Vec3(0, 0, -2));
      ASSERT_TRUE(hit) << x << " " << y;
      EXPECT_EQ(hit->distance, 3);
    }
  EXPECT_FALSE(tree.first_hit(Vec3(-1, 4, 0), Vec3(1, 0, 0))) << "edge-on";
}

TEST(RayTree, IsAccurateFarAwayAndForShortDirections) {
  const RayTree tree(make_box(Vec3(-1, -1, -1), Vec3(2, 2, 2)));
  const auto hit = tree.first_hit(Vec3(1e7, 0.25, 0.5), Vec3(-1e-200, 0, 0));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->distance, 1e7 - 1);
}

TEST(RayTree, WithoutTrianglesOrWithFlatOnesIsNeverHit) {
  EXPECT_FALSE(RayTree(TriangleMesh()).first_hit(Vec3::Zero(), Vec3::UnitX()));
  TriangleMesh line;
  line.vertices = {{1, -1, 0}, {1, 1, 0}, {1, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_FALSE(RayTree(line).first_hit(Vec3::Zero(), Vec3::UnitX()));
}

TEST(RayTree, RefusesBrokenMeshesAndRays) {
  TriangleMesh mesh = make_box(Vec3::Zero(), Vec3::Ones());
  const RayTree tree(mesh);
  EXPECT_THROW(tree.first_hit(Vec3(kNan, 0, 0), Vec3::UnitX()), InputError);
  EXPECT_THROW(tree.first_hit(Vec3::Zero(), Vec3(0, kInfinity, 0)), InputError);
  EXPECT_THROW(tree.first_hit(Vec3::Zero(), Vec3::Zero()), InputError);
  EXPECT_THROW(tree.first_hit(Vec3::Zero(), Vec3::UnitX(), kNan), InputError);
  mesh.vertices[2].x() = kNan;
  EXPECT_THROW(RayTree(mesh, "wall"), InputError);
  mesh = make_box(Vec3::Zero(), Vec3::Ones());
  mesh.triangles[0][2] = 99;
  EXPECT_THROW(RayTree(mesh, "wall"), InputError);
}

}  // namespace
}  // namespace navvy::geometry
