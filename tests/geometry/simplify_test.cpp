// SPDX-License-Identifier: Apache-2.0
#include "geometry/simplify.h"

#include <gtest/gtest.h>

#include "geometry/bodies.h"

namespace navvy::geometry {
namespace {

TEST(Simplify, KeepsMeshesThatAreSmallEnough) {
  const TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
  EXPECT_EQ(simplified(box, 12).triangles, box.triangles);
}

TEST(Simplify, KeepsTheShapeWithFewTriangles) {
  TriangleMesh ball = make_ellipsoid(Vec3(3, 2, 1), 6);
  ASSERT_EQ(ball.triangles.size(), 8u * 4096);
  ball.materials.resize(2);
  for (const auto& t : ball.triangles)
    ball.material_of.push_back(ball.vertices[static_cast<std::size_t>(t[0])].x() > 0 ? 1 : 0);
  const TriangleMesh few = simplified(ball, 1000);
  EXPECT_LE(few.triangles.size(), 1000u);
  EXPECT_GT(few.triangles.size(), 300u);
  require_valid(few, "few");
  for (std::size_t t = 0; t < few.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      // Near the ellipsoid, and with the material of its side.
      const Vec3& p = few.corner(t, i);
      EXPECT_NEAR(p.cwiseQuotient(Vec3(3, 2, 1)).norm(), 1, 0.1);
      if (std::abs(p.x()) > 0.7) EXPECT_EQ(few.material_of[t], p.x() > 0 ? 1 : 0);
    }
  const Box box = bounds(few);
  EXPECT_LT((box.high - Vec3(3, 2, 1)).norm(), 0.3);
}

TEST(Simplify, EndsForMeshesOfAPoint) {
  TriangleMesh point;
  point.vertices = {Vec3::Ones(), Vec3::Ones(), Vec3::Ones()};
  for (int i = 0; i < 100; ++i) point.triangles.push_back({0, 1, 2});
  EXPECT_TRUE(simplified(point, 10).triangles.empty());
}

}  // namespace
}  // namespace navvy::geometry
