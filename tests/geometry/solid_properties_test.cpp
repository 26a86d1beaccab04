// SPDX-License-Identifier: Apache-2.0
#include "geometry/solid_properties.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/bodies.h"

namespace navvy::geometry {
namespace {

// Sums of some hundred terms in double: 1e-13 of the size is ten times their rounding.
constexpr double kRounding = 1e-13;

TEST(SolidProperties, OfABoxMatchTheClosedForm) {
  const Vec3 e(0.4, 1.1, 2.3);
  const SolidProperties box = solid_properties(make_box(Vec3(3, -2, 1), e));
  const double v = e.prod();
  EXPECT_NEAR(box.volume, v, kRounding);
  EXPECT_TRUE(box.p_BCom.isApprox(Vec3(3, -2, 1) + 0.5 * e, kRounding));
  const Vec3 moments(e.y() * e.y() + e.z() * e.z(), e.z() * e.z() + e.x() * e.x(),
                     e.x() * e.x() + e.y() * e.y());
  EXPECT_TRUE(box.inertia.isApprox(Mat3((v / 12 * moments).asDiagonal()), kRounding))
      << box.inertia;
}

TEST(SolidProperties, OfATetrahedronHaveItsProductsOfInertia) {
  // Right-angled, edges a b c from one corner: volume abc / 6, centre at a quarter of the edges;
  // about the centre the second moments are 3 V a^2 / 80 and the mixed ones -V a b / 80.
  const double a = 1.5, b = 0.8, c = 2;
  const SolidProperties t = solid_properties(make_tetrahedron(a, b, c));
  const double v = a * b * c / 6;
  EXPECT_NEAR(t.volume, v, kRounding);
  EXPECT_TRUE(t.p_BCom.isApprox(Vec3(a, b, c) / 4, kRounding));
  EXPECT_NEAR(t.inertia(0, 0), 3 * v / 80 * (b * b + c * c), kRounding);
  EXPECT_NEAR(t.inertia(1, 1), 3 * v / 80 * (c * c + a * a), kRounding);
  EXPECT_NEAR(t.inertia(2, 2), 3 * v / 80 * (a * a + b * b), kRounding);
  EXPECT_NEAR(t.inertia(0, 1), v * a * b / 80, kRounding);
  EXPECT_NEAR(t.inertia(1, 2), v * b * c / 80, kRounding);
  EXPECT_NEAR(t.inertia(0, 2), v * a * c / 80, kRounding);
  EXPECT_EQ(t.inertia(1, 0), t.inertia(0, 1));
}

TEST(SolidProperties, OfSphereAndEllipsoidConvergeAtSecondOrder) {
  for (const Vec3& r : {Vec3(1, 1, 1), Vec3(0.5, 1, 2)}) {
    const double v = 4.0 / 3 * kPi * r.prod();
    const Vec3 moments(r.y() * r.y() + r.z() * r.z(), r.z() * r.z() + r.x() * r.x(),
                       r.x() * r.x() + r.y() * r.y());
    double last_volume = 0, last_inertia = 0;
    for (const int levels : {3, 4, 5}) {
      const SolidProperties s = solid_properties(make_ellipsoid(r, levels));
      const double volume_error = 1 - s.volume / v;
      const double inertia_error =
          (s.inertia - Mat3((v / 5 * moments).asDiagonal())).norm() / (v / 5 * moments).norm();
      EXPECT_LT(s.p_BCom.norm(), 1e-12);
      // Chords cut off a share that goes with the square of their length; the exact order shows
      // that there is no other error.
      if (last_volume > 0) {
        EXPECT_NEAR(last_volume / volume_error, 4, 0.1);
        EXPECT_NEAR(last_inertia / inertia_error, 4, 0.1);
      }
      last_volume = volume_error;
      last_inertia = inertia_error;
    }
    EXPECT_LT(last_volume, 0.002);
  }
}

TEST(SolidProperties, AreAccurateFarFromTheOrigin) {
  const Vec3 far(5e5, -4e6, 300);
  const SolidProperties s = solid_properties(make_box(far, Vec3(1, 2, 3)));
  // The box's own corners are rounded to 5e-10 m there.
  EXPECT_NEAR(s.volume, 6, 1e-8);
  EXPECT_TRUE((s.p_BCom - far).isApprox(Vec3(0.5, 1, 1.5), 1e-8));
  EXPECT_NEAR(s.inertia(0, 0), 6.0 / 12 * 13, 1e-7);
}

TEST(SolidProperties, RefuseOpenFoldedInvertedAndFlatMeshes) {
  TriangleMesh open = make_box(Vec3::Zero(), Vec3::Ones());
  open.triangles.pop_back();
  EXPECT_THROW(solid_properties(open, "bed"), InputError);
  TriangleMesh folded = make_box(Vec3::Zero(), Vec3::Ones());
  std::swap(folded.triangles[0][0], folded.triangles[0][1]);
  EXPECT_THROW(solid_properties(folded), InputError);
  TriangleMesh inverted = make_box(Vec3::Zero(), Vec3::Ones());
  for (auto& t : inverted.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW(solid_properties(inverted), InputError);
  EXPECT_THROW(solid_properties(make_box(Vec3::Zero(), Vec3(1, 1, 0))), InputError);
  EXPECT_THROW(solid_properties(TriangleMesh()), InputError);
  try {
    solid_properties(open, "bed");
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bed"), std::string::npos);
  }
}

TEST(SolidProperties, WeldFacesWithSeparateVertices) {
  TriangleMesh mesh = make_box(Vec3::Zero(), Vec3::Ones());
  mesh.vertices.push_back(mesh.vertices[0]);
  mesh.triangles[0][0] = 8;
  EXPECT_NEAR(solid_properties(mesh).volume, 1, kRounding);
}

}  // namespace
}  // namespace navvy::geometry
