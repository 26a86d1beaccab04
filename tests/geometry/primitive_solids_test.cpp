// SPDX-License-Identifier: Apache-2.0
#include "geometry/primitive_solids.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/bodies.h"

namespace navvy::geometry {
namespace {

constexpr double kRounding = 1e-12;

/// Returns a closed body of revolution about z by its outline (z, radius), fine enough for 1e-3.
TriangleMesh turned(const std::vector<Vec2>& outline) {
  constexpr int kSides = 256;
  TriangleMesh mesh;
  for (const Vec2& at : outline)
    for (int i = 0; i < kSides; ++i) {
      const double a = 2 * kPi * i / kSides;
      mesh.vertices.emplace_back(at.y() * std::cos(a), at.y() * std::sin(a), at.x());
    }
  const int rings = static_cast<int>(outline.size());
  for (int r = 0; r + 1 < rings; ++r)
    for (int i = 0; i < kSides; ++i) {
      const int a = r * kSides + i, b = r * kSides + (i + 1) % kSides;
      mesh.triangles.push_back({a, b, b + kSides});
      mesh.triangles.push_back({a, b + kSides, a + kSides});
    }
  const int low = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, outline.front().x());
  mesh.vertices.emplace_back(0, 0, outline.back().x());
  for (int i = 0; i < kSides; ++i) {
    const int a = i, b = (i + 1) % kSides, top = (rings - 1) * kSides;
    mesh.triangles.push_back({low, b, a});
    mesh.triangles.push_back({low + 1, top + a, top + b});
  }
  return mesh;
}

void expect_same(const SolidProperties& a, const SolidProperties& b, double share) {
  EXPECT_NEAR(a.volume, b.volume, share * b.volume);
  EXPECT_LT((a.p_BCom - b.p_BCom).norm(), share);
  EXPECT_LT((a.inertia - b.inertia).norm(), share * b.inertia.norm()) << a.inertia << "\n"
                                                                      << b.inertia;
}

TEST(PrimitiveSolids, EqualTheMeshesOfTheirShapes) {
  const Vec3 e(0.4, 1.1, 2.3);
  expect_same(solid_box(e), solid_properties(make_box(-0.5 * e, e)), kRounding);
  // 256 sides and 64 rings lack some 1e-4 of the round body's volume.
  constexpr double kSided = 1e-3;
  expect_same(solid_cylinder(0.3, 1.4), solid_properties(turned({{-0.7, 0.3}, {0.7, 0.3}})),
              kSided);
  expect_same(solid_cone(0.5, 1.2),
              solid_properties(turned({{-0.6, 0.5}, {0.6 - 1e-6, 1e-6 * 0.5 / 1.2}})), kSided);
  std::vector<Vec2> ball, pill;
  for (int i = 0; i <= 64; ++i) {
    const double up = kPi * (i / 64.0 - 0.5), z = 0.4 * std::sin(up),
                 r = std::max(0.4 * std::cos(up), 1e-7);
    ball.emplace_back(z + (i == 0 ? -1e-9 : 0), r);
    pill.emplace_back(i < 32 ? z - 0.5 : z + 0.5, r);
  }
  expect_same(solid_sphere(0.4), solid_properties(turned(ball)), 2e-3);
  expect_same(solid_capsule(0.4, 1.0), solid_properties(turned(pill)), 2e-3);
}

TEST(PrimitiveSolids, TwoHalvesOfABoxAreTheBox) {
  // Each half is turned and moved into place, which undoes the cut.
  const Pose left = make_pose(-0.5, 0, 0), right = make_pose(0.5, 0, 0, 0, 0, kPi);
  const SolidProperties half = solid_box(Vec3(1, 0.6, 0.8));
  expect_same(joined(placed(half, left), placed(half, right)), solid_box(Vec3(2, 0.6, 0.8)),
              kRounding);
  EXPECT_NEAR(weighed(half, 7850).volume, 7850 * 0.48, 1e-9);
}

}  // namespace
}  // namespace navvy::geometry
