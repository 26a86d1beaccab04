// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangle_mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "geometry/bodies.h"

namespace navvy::geometry {
namespace {

std::string fault_of(const TriangleMesh& mesh) {
  try {
    require_valid(mesh, "body");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TriangleMesh, ReturnsItsCornersNormalsAndBounds) {
  const TriangleMesh box = make_box(Vec3(1, 2, 3), Vec3(0.5, 1, 2));
  EXPECT_EQ(box.corner(2, 1), Vec3(1.5, 2, 5));
  EXPECT_EQ(box.area_vector(0), Vec3(0, 0, -0.5));  // the floor faces down; twice half of 0.5 m2
  EXPECT_EQ(bounds(box).low, Vec3(1, 2, 3));
  EXPECT_EQ(bounds(box).high, Vec3(1.5, 3, 5));
  EXPECT_EQ(bounds(TriangleMesh()).high, Vec3(0, 0, 0));
}

TEST(TriangleMesh, IsRefusedWithTheFaultyVertexOrTriangle) {
  EXPECT_EQ(fault_of(make_box(Vec3::Zero(), Vec3::Ones())), "");
  TriangleMesh mesh = make_box(Vec3::Zero(), Vec3::Ones());
  mesh.vertices[5].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(fault_of(mesh).find("body/vertex[5]"), std::string::npos) << fault_of(mesh);
  for (const int wrong : {-1, 8}) {
    mesh = make_box(Vec3::Zero(), Vec3::Ones());
    mesh.triangles[3][1] = wrong;
    EXPECT_NE(fault_of(mesh).find("body/triangle[3]"), std::string::npos) << fault_of(mesh);
  }
}

TEST(TriangleMesh, NeedsAMaterialForEveryTriangleOrForNone) {
  TriangleMesh mesh = make_tetrahedron(1, 1, 1);
  mesh.materials.resize(1);
  mesh.material_of = {0, -1, 0, 0};
  EXPECT_EQ(fault_of(mesh), "");
  mesh.material_of = {0, 1, 0, 0};
  EXPECT_NE(fault_of(mesh), "");
  mesh.material_of = {0, 0, 0};
  EXPECT_NE(fault_of(mesh), "");
}

TEST(TriangleMesh, WeldingUnitesVerticesAtOnePlaceAndKeepsTheTriangles) {
  const TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
  TriangleMesh loose;
  for (const auto& t : box.triangles) {
    const int n = static_cast<int>(loose.vertices.size());
    for (const int v : t) loose.vertices.push_back(box.vertices[static_cast<std::size_t>(v)]);
    loose.triangles.push_back({n, n + 1, n + 2});
  }
  loose.vertices[0].x() = -0.0;
  const TriangleMesh mesh = welded(loose);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  ASSERT_EQ(mesh.triangles.size(), 12u);
  for (std::size_t t = 0; t < 12; ++t)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(mesh.corner(t, i), box.corner(t, i));
}

}  // namespace
}  // namespace navvy::geometry
