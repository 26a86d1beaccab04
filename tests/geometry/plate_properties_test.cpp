// SPDX-License-Identifier: Apache-2.0
#include "geometry/plate_properties.h"

#include <gtest/gtest.h>

namespace navvy::geometry {
namespace {

/// A rectangle a x b in the plane z = 0, cut into two triangles, its corner at the origin.
TriangleMesh rectangle(double a, double b) {
  TriangleMesh out;
  out.vertices = {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}};
  out.triangles = {{0, 1, 2}, {0, 2, 3}};
  return out;
}

TEST(PlateProperties, OfARectangleAreThoseOfABox) {
  const double a = 2, b = 0.5, t = 0.03;
  const SolidProperties plate = plate_properties(rectangle(a, b), t);
  EXPECT_NEAR(plate.volume, a * b * t, 1e-15);
  EXPECT_NEAR((plate.p_BCom - Vec3(a / 2, b / 2, 0)).norm(), 0, 1e-15);
  const Vec3 box = plate.volume / 12 * Vec3(b * b + t * t, a * a + t * t, a * a + b * b);
  EXPECT_NEAR((plate.inertia - Mat3(box.asDiagonal())).norm(), 0, 1e-15);
}

TEST(PlateProperties, DoNotDependOnCutsWindingAndPlace) {
  const double t = 0.02;
  const SolidProperties whole = plate_properties(rectangle(1, 3), t);
  // The same rectangle as four triangles about an inner point, wound both ways, turned and moved.
  TriangleMesh cut = rectangle(1, 3);
  cut.vertices.emplace_back(0.3, 1.1, 0);
  cut.triangles = {{0, 1, 4}, {1, 2, 4}, {4, 3, 2}, {3, 4, 0}};
  const Pose X = make_pose(5, -7, 2, 0.4, -0.9, 2.2);
  for (Vec3& v : cut.vertices) v = X * v;
  const SolidProperties moved = plate_properties(cut, t);
  EXPECT_NEAR(moved.volume, whole.volume, 1e-14);
  EXPECT_NEAR((moved.p_BCom - X * whole.p_BCom).norm(), 0, 1e-12);
  const Mat3 turned = X.linear() * whole.inertia * X.linear().transpose();
  EXPECT_NEAR((moved.inertia - turned).norm(), 0, 1e-11);
}

TEST(PlateProperties, AreEmptyWithoutArea) {
  TriangleMesh line = rectangle(1, 0);
  EXPECT_EQ(plate_properties(line, 0.1).volume, 0);
  EXPECT_EQ(plate_properties({}, 0.1).volume, 0);
}

}  // namespace
}  // namespace navvy::geometry
