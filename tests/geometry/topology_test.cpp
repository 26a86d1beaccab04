// SPDX-License-Identifier: Apache-2.0
#include "geometry/topology.h"

#include <gtest/gtest.h>

#include "geometry/bodies.h"

namespace navvy::geometry {
namespace {

/// Returns both meshes as one.
TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const int n = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return a;
}

TEST(WindingClash, NamesAFlippedTriangle) {
  TriangleMesh mesh = make_box(Vec3::Zero(), Vec3::Ones());
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  ASSERT_TRUE(find_winding_clash(mesh).has_value());
  EXPECT_EQ(find_winding_clash(mesh)->first, 0u);
}

TEST(WindingClash, IsAbsentOnAConsistentlyWoundOpenSurface) {
  TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
  box.triangles.resize(6);
  EXPECT_FALSE(find_winding_clash(box).has_value());
}

TEST(SolidMesh, IsClosedAndFacesOutwardsInEveryPiece) {
  const TriangleMesh large = make_box(Vec3::Zero(), Vec3::Constant(3));
  EXPECT_TRUE(is_solid(large));
  EXPECT_TRUE(is_solid(together(large, make_box(Vec3(5, 0, 0), Vec3::Ones()))));
  TriangleMesh inward = make_box(Vec3(5, 0, 0), Vec3::Ones());
  for (auto& t : inward.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(is_solid(inward));
  EXPECT_FALSE(is_solid(together(large, inward))) << "a small piece is found beside a large one";
  TriangleMesh open = large;
  open.triangles.pop_back();
  EXPECT_FALSE(is_solid(open));
}

TEST(SolidMesh, ToleratesBodiesThatShareAnEdge) {
  // Two boxes that touch along an edge: four triangles meet there, and each direction is traversed
  // twice.
  const TriangleMesh both =
      together(make_box(Vec3::Zero(), Vec3::Ones()), make_box(Vec3(1, 1, 0), Vec3::Ones()));
  EXPECT_TRUE(is_solid(both));
}

}  // namespace
}  // namespace navvy::geometry
