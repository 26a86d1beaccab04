// SPDX-License-Identifier: Apache-2.0
#include "geometry/topology.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "geometry/bodies.h"

namespace navvy::geometry {
namespace {

/// Both meshes as one.
TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const int n = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return a;
}

TEST(MeshReport, OfAClosedBodyIsClean) {
  const MeshReport report = inspect(make_box(Vec3::Zero(), Vec3::Ones()));
  EXPECT_TRUE(report.closed());
  EXPECT_TRUE(report.oriented());
  EXPECT_EQ(report.flat_triangles, 0);
  EXPECT_EQ(report.pieces, 1);
}

TEST(MeshReport, CountsTheRimOfAnOpenBoxAndItsPieces) {
  TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
  box.triangles.erase(box.triangles.begin() + 2, box.triangles.begin() + 4);  // the lid
  const MeshReport report = inspect(together(box, make_tetrahedron(1, 1, 1)));
  EXPECT_EQ(report.free_edges, 4);
  EXPECT_FALSE(report.closed());
  EXPECT_TRUE(report.oriented());
  EXPECT_EQ(report.pieces, 2);
}

TEST(MeshReport, FindsWingsTurnedTrianglesAndFlatOnes) {
  TriangleMesh mesh = make_box(Vec3::Zero(), Vec3::Ones());
  mesh.vertices.emplace_back(2, 2, 2);
  mesh.triangles.push_back({0, 1, 8});  // a third triangle on an edge
  EXPECT_EQ(inspect(mesh).crowded_edges, 1);
  EXPECT_FALSE(inspect(mesh).closed());

  mesh = make_box(Vec3::Zero(), Vec3::Ones());
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_EQ(inspect(mesh).clashing_edges, 3);
  EXPECT_TRUE(inspect(mesh).closed());
  EXPECT_FALSE(inspect(mesh).oriented());
  ASSERT_TRUE(find_winding_clash(mesh).has_value());
  EXPECT_EQ(find_winding_clash(mesh)->first, 0u);

  mesh = make_box(Vec3::Zero(), Vec3::Ones());
  mesh.triangles.push_back({3, 3, 5});
  EXPECT_EQ(inspect(mesh).flat_triangles, 1);
}

TEST(MeshReport, RefusesWhatIsNoMesh) {
  TriangleMesh mesh = make_tetrahedron(1, 1, 1);
  mesh.vertices[0].z() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(inspect(mesh), InputError);
}

TEST(WindingClash, IsNoneOnAnOpenSurfaceOfOneFront) {
  TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
  box.triangles.resize(6);
  EXPECT_FALSE(find_winding_clash(box).has_value());
}

TEST(SolidMesh, IsClosedAndTurnedOutwardsPieceByPiece) {
  const TriangleMesh large = make_box(Vec3::Zero(), Vec3::Constant(3));
  EXPECT_TRUE(is_solid(large));
  EXPECT_TRUE(is_solid(together(large, make_box(Vec3(5, 0, 0), Vec3::Ones()))));
  TriangleMesh inward = make_box(Vec3(5, 0, 0), Vec3::Ones());
  for (auto& t : inward.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(is_solid(inward));
  EXPECT_FALSE(is_solid(together(large, inward))) << "a large piece hides no small one";
  TriangleMesh open = large;
  open.triangles.pop_back();
  EXPECT_FALSE(is_solid(open));
}

TEST(SolidMesh, ToleratesBodiesThatShareAnEdge) {
  // Two boxes that touch along an edge: four triangles meet there, run through twice either way.
  const TriangleMesh both =
      together(make_box(Vec3::Zero(), Vec3::Ones()), make_box(Vec3(1, 1, 0), Vec3::Ones()));
  EXPECT_TRUE(is_solid(both));
  EXPECT_EQ(inspect(welded(both)).crowded_edges, 1);
}

}  // namespace
}  // namespace navvy::geometry
