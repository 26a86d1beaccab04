// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "soil/rig.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::soil {
namespace {

TEST(ShellGeometry, KnowsInsideAndOutsideOfAnOpenBoxAlsoAtItsEdges) {
  const ShellGeometry box(rig::open_box(1.0, 0.8, 0.6), 0.1);
  EXPECT_NEAR(box.distance(Vec3(0, 0, 0.1)), 0.1, 1e-12);
  EXPECT_NEAR(box.distance(Vec3(0, 0, -0.1)), -0.1, 1e-12);
  // In an inner corner.
  EXPECT_NEAR(box.distance(Vec3(0.45, 0.35, 0.05)), 0.05, 1e-12);
  // Outside a corner the closest face alone may give "inside": the pseudo-normal does not.
  EXPECT_NEAR(box.distance(Vec3(0.6, 0.5, -0.1)), -std::sqrt(0.03), 1e-12);
  EXPECT_NEAR(box.distance(Vec3(0.55, 0, -0.2)), -std::hypot(0.05, 0.2), 1e-12);
}

TEST(ShellGeometry, FindsTheSameDistanceFromEveryGuess) {
  const ShellGeometry box(rig::open_box(1.0, 0.8, 0.6), 0.1);
  const int n = static_cast<int>(box.triangles().size());
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(0.7 * std::sin(1.3 * i), 0.6 * std::sin(2.1 * i), 0.3 + 0.5 * std::sin(0.7 * i));
    int first = 0;
    const double wanted = box.distance(p, first);
    for (int guess = 0; guess < n; ++guess) {
      int closest = guess;
      EXPECT_NEAR(box.distance(p, closest), wanted, 1e-12);
      EXPECT_GE(closest, 0);
      EXPECT_LT(closest, n);
    }
  }
}

TEST(ShellGeometry, SharpFoldsOfAClosedBodyCountAsEdgesAndNoOthersDo) {
  // A box whose outside is its front: twelve edges, not the six diagonals of its faces. Turned
  // inside out, as a tank, none; with its lid open the four of the rim.
  scene::Shell box = lab::closed_box(1.0, 0.8, 0.6);
  EXPECT_EQ(ShellGeometry(box, 0.1).rims().size(), 12u);
  for (auto& triangle : box.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_EQ(ShellGeometry(box, 0.1).rims().size(), 0u);
  EXPECT_EQ(ShellGeometry(rig::open_box(1.0, 0.8, 0.6), 0.1).rims().size(), 4u);
}

TEST(ShellGeometry, FindsTheRimAndOnlyTheRim) {
  const ShellGeometry box(rig::open_box(1.0, 0.8, 0.6), 0.1);
  ASSERT_EQ(box.rims().size(), 4u);
  double length = 0;
  for (const auto& rim : box.rims()) {
    EXPECT_EQ(rim[0].z(), 0.6);
    EXPECT_EQ(rim[1].z(), 0.6);
    length += (rim[1] - rim[0]).norm();
  }
  EXPECT_NEAR(length, 3.6, 1e-12);
}

TEST(ShellGeometry, PiecesCoverTheShellWithoutGapsAndStaySmall) {
  const ShellGeometry box(rig::open_box(1.0, 0.8, 0.6), 0.1);
  double area = 0;
  for (const auto& piece : box.pieces()) {
    const Vec3 a = piece.corner[1] - piece.corner[0], b = piece.corner[2] - piece.corner[0];
    area += 0.5 * a.cross(b).norm();
    EXPECT_LE(std::max({a.norm(), b.norm(), (b - a).norm()}), 0.3 + 1e-12);
  }
  EXPECT_NEAR(area, 0.8 + 2 * 0.6 * 1.8, 1e-9);
}

TEST(ShellGeometry, HoldsSoilInsideAndHeapedOverTheMouth) {
  const ShellGeometry box(rig::open_box(1.0, 0.8, 0.6), 0.1);
  EXPECT_TRUE(box.holds(Vec3(0, 0, 0.3)));
  // In the heap.
  EXPECT_TRUE(box.holds(Vec3(0, 0, 0.75)));
  EXPECT_FALSE(box.holds(Vec3(0, 0, 1.5)));
  EXPECT_FALSE(box.holds(Vec3(0, 0, -0.05)));
  EXPECT_FALSE(box.holds(Vec3(0.6, 0, 0.3)));
}

TEST(ShellGeometry, RefusesShellsThatAreNone) {
  scene::Shell shell;
  shell.name = "nothing";
  EXPECT_THROW(ShellGeometry(shell, 0.1), InputError);
  shell.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  shell.triangles = {{0, 1, 2}};
  EXPECT_THROW(ShellGeometry(shell, 0.1), InputError);
  shell.triangles = {{0, 1, 3}};
  EXPECT_THROW(ShellGeometry(shell, 0.1), InputError);
}

}  // namespace
}  // namespace navvy::soil
