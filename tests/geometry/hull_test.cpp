// SPDX-License-Identifier: Apache-2.0
#include "geometry/hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/random.h"
#include "geometry/bodies.h"
#include "geometry/solid_properties.h"
#include "geometry/topology.h"

namespace navvy::geometry {
namespace {

std::vector<Vec3> cloud(int n, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i)
    points.emplace_back(random.uniform(-1, 1), random.uniform(-2, 2), random.uniform(0, 1));
  return points;
}

/// Returns every plane through three points that has all others behind it, by brute force: n^4.
std::vector<Plane> planes_by_force(std::vector<Vec3> points) {
  std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  std::vector<Plane> planes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        Vec3 n = (points[j] - points[i]).cross(points[k] - points[i]);
        if (n.norm() < 1e-14) continue;
        n.normalize();
        double least = 0, most = 0;
        for (const Vec3& p : points) {
          least = std::min(least, n.dot(p - points[i]));
          most = std::max(most, n.dot(p - points[i]));
        }
        if (least < -1e-7 && most > 1e-7) continue;
        if (most > 1e-7) n = -n;
        const double offset = n.dot(points[i]);
        if (std::none_of(planes.begin(), planes.end(), [&](const Plane& p) {
              return (p.normal - n).norm() < 1e-6 && std::abs(p.offset - offset) < 1e-6;
            }))
          planes.push_back({n, offset});
      }
  return planes;
}

void expect_equal_bits(const std::vector<Plane>& a, const std::vector<Plane>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].normal, b[i].normal) << i;
    EXPECT_EQ(a[i].offset, b[i].offset) << i;
  }
}

TEST(ConvexHull, OfABoxWithPointsInItsFacesHasSixPlanesAndEightCorners) {
  std::vector<Vec3> points;
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 4; ++y)
      for (int z = 0; z <= 4; ++z) points.emplace_back(0.1 * x, 0.3 * y, 0.7 * z);
  const ConvexHull hull = convex_hull(points);
  EXPECT_EQ(hull.planes.size(), 6u);
  EXPECT_NEAR(solid_properties(hull.mesh).volume, 0.4 * 1.2 * 2.8, 1e-12);
}

TEST(ConvexHull, HasTheSamePlanesAsBruteForceBitForBit) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<Vec3> points = cloud(30, seed);
    expect_equal_bits(convex_hull(points).planes, planes_by_force(points));
  }
  // Faces of many points, as in plates and drums.
  std::vector<Vec3> drum;
  for (int i = 0; i < 12; ++i)
    for (const double y : {-0.2, 0.2})
      drum.emplace_back(std::cos(kPi * i / 6), y, std::sin(kPi * i / 6));
  expect_equal_bits(convex_hull(drum).planes, planes_by_force(drum));
}

TEST(ConvexHull, HoldsAllPointsAndIsAClosedConvexBody) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const std::vector<Vec3> points = cloud(400, seed);
    const ConvexHull hull = convex_hull(points);
    EXPECT_TRUE(is_solid(hull.mesh));
    EXPECT_EQ(hull.mesh.triangles.size(), 2 * hull.mesh.vertices.size() - 4) << "Euler";
    for (const Vec3& p : points)
      // Random points have no faces of more than three, so a plane is exact except for rounding.
      for (const Plane& plane : hull.planes) EXPECT_LE(plane.normal.dot(p), plane.offset + 1e-12);
  }
}

TEST(ConvexHull, OfASphereKeepsEveryPoint) {
  const TriangleMesh sphere = make_ellipsoid(Vec3::Ones(), 4);
  const ConvexHull hull = convex_hull(sphere.vertices);
  EXPECT_EQ(hull.mesh.vertices.size(), sphere.vertices.size());
  // Symmetric patches of the octahedron are flat quads; either cut gives the same volume.
  EXPECT_NEAR(solid_properties(hull.mesh).volume, solid_properties(sphere).volume, 1e-4);
}

TEST(ConvexHull, DoesNotDependOnOrderOrDuplicates) {
  std::vector<Vec3> points = cloud(60, 7);
  const ConvexHull hull = convex_hull(points);
  std::reverse(points.begin(), points.end());
  points.insert(points.end(), points.begin(), points.begin() + 20);
  const ConvexHull again = convex_hull(points);
  expect_equal_bits(hull.planes, again.planes);
  EXPECT_EQ(hull.mesh.triangles, again.mesh.triangles);
}

TEST(ConvexHull, SurvivesPointsNearlyInAFace) {
  // Noise from a millionth of the tolerance up to ten times it on the faces of a box: the body must
  // stay closed with the volume of the box.
  for (const double noise : {1e-13, 1e-9, 1e-7, 1e-6}) {
    Random random(3);
    std::vector<Vec3> points;
    for (int i = 0; i < 300; ++i) {
      Vec3 p(random.uniform(), random.uniform(), random.uniform());
      p[i % 3] = (i % 2) + random.uniform(-noise, noise);
      points.push_back(p);
    }
    for (int k = 0; k < 8; ++k) points.emplace_back(k & 1, (k >> 1) & 1, k >> 2);
    const ConvexHull hull = convex_hull(points);
    EXPECT_TRUE(is_solid(hull.mesh));
    EXPECT_NEAR(solid_properties(hull.mesh).volume, 1, 10 * noise + 1e-12);
    // A plane may cut off points within the tolerance, 1e-7 of the diagonal.
    for (const Plane& plane : hull.planes)
      for (const Vec3& p : points) EXPECT_LE(plane.normal.dot(p) - plane.offset, 2e-7);
  }
}

TEST(ConvexHull, OfAPlateHasItsPlaneFacingBothSides) {
  const ConvexHull hull = convex_hull({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0, 1}});
  EXPECT_TRUE(hull.mesh.triangles.empty());
  ASSERT_EQ(hull.planes.size(), 2u);
  EXPECT_EQ(hull.planes[0].normal, -hull.planes[1].normal);
  EXPECT_EQ(std::abs(hull.planes[0].offset), 1);
}

TEST(ConvexHull, RefusesLinesPointsAndNonFiniteNumbers) {
  EXPECT_THROW(convex_hull({}), InputError);
  EXPECT_THROW(convex_hull({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}), InputError);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}), InputError);
  EXPECT_THROW(
      convex_hull(
          {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::numeric_limits<double>::quiet_NaN()}}),
      InputError);
}

}  // namespace
}  // namespace navvy::geometry
