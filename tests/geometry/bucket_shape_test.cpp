// SPDX-License-Identifier: Apache-2.0
#include "geometry/bucket_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/solid_properties.h"
#include "geometry/topology.h"

namespace navvy::geometry {
namespace {

const BucketSize kDigging{1.05, 1.4, 0.03, 0.035}, kTrenching{0.45, 1.4, 0.025, 0.015},
    kDitching{1.8, 1.0, 0.02, 0.0};

/// Returns the heaped capacity of a shell by columns across its mouth: each reaches from the mouth
/// down to the inner face of the plate that it meets, and up to a heap with slopes of 1:1. Reads
/// nothing of the shape but the shell.
double measured(const TriangleMesh& shell, double plate) {
  const std::size_t n = (shell.vertices.size() - 2) / 2;
  const Vec3 edge = shell.vertices[0], back = shell.vertices[n - 1];
  const Vec3 along = Vec3(back.x() - edge.x(), 0, back.z() - edge.z()).normalized();
  const Vec3 inward = Vec3::UnitY().cross(along).z() > 0 ? Vec3(Vec3::UnitY().cross(along))
                                                         : Vec3(-Vec3::UnitY().cross(along));
  const double length = (back - edge).dot(along), wide = edge.y();
  constexpr int kAlong = 500, kAcross = 240;
  const double du = length / kAlong, dy = 2 * wide / kAcross;
  std::vector<std::vector<char>> open(kAlong, std::vector<char>(kAcross, 0));
  double struck = 0, u0 = length, u1 = 0, narrow = wide;
  for (int i = 0; i < kAlong; ++i) {
    const double u = (i + 0.5) * du;
    const Vec3 at(edge.x() + u * along.x(), 0, edge.z() + u * along.z());
    double half = 0;
    for (int k = 0; k < kAcross; ++k) {
      const Vec3 p = at + ((k + 0.5) * dy - wide) * Vec3::UnitY();
      double depth = 1e9;
      for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
        const Vec3 normal = shell.area_vector(t).normalized();
        // The inner face: the triangle's plane, half a plate towards the inside.
        const double d = normal.dot(shell.corner(t, 0)) + 0.5 * plate - normal.dot(p);
        if (d > 0) depth = -1;  // the point is in the plate or outside
        const double speed = -normal.dot(inward);
        if (depth > 0 && speed > 1e-9) depth = std::min(depth, -d / speed);
        if (depth < 0) break;
      }
      if (depth <= 0) continue;
      struck += depth * du * dy;
      half = std::max(half, std::abs((k + 0.5) * dy - wide));
    }
    if (half <= 0) continue;
    u0 = std::min(u0, u - du / 2);
    u1 = std::max(u1, u + du / 2);
    narrow = std::min(narrow, half + dy / 2);
  }
  // Heap on the mouth between the inner faces, whose sides taper.
  const double slope = (wide - shell.vertices[n - 1].y()) / length;
  double heap = 0;
  const double at0 = wide - 0.5 * plate * std::hypot(1.0, slope);
  for (int i = 0; i < kAlong; ++i)
    for (int k = 0; k < kAcross; ++k) {
      const double u = (i + 0.5) * du, y = std::abs((k + 0.5) * dy - wide);
      const double side = (at0 - slope * u - y) / std::hypot(1.0, slope);
      heap += std::max(0.0, std::min({u - u0, u1 - u, side})) * du * dy;
    }
  return struck + heap;
}

TEST(BucketShape, HoldsTheCapacityThatWasAskedFor) {
  for (const BucketSize& size : {kDigging, kTrenching, kDitching}) {
    const auto [least, most] = heaped_capacities(size);
    EXPECT_GT(least, 0);
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
      const double asked = least + share * (most - least), depth = depth_for(size, asked);
      EXPECT_NEAR(heaped_capacity(size, depth), asked, 1e-9 * asked);
      // 1 % of the asked capacity; the columns themselves are exact to 0.3 %.
      EXPECT_NEAR(measured(bucket_shell(size, depth), size.plate), asked, 0.01 * asked)
          << "width " << size.width << ", depth " << depth;
    }
  }
}

TEST(BucketShape, IsAsWideAsAskedAndEndsAtTheTipRadius) {
  const TriangleMesh shell = bucket_shell(kDigging, 1);
  const Box box = bounds(shell);
  // The outer faces of the side plates are half a plate further out.
  EXPECT_NEAR(box.high.y() - box.low.y() + kDigging.plate, kDigging.width, 1e-12);
  EXPECT_NEAR(box.high.x(), kDigging.tip_radius, 1e-12);
  EXPECT_NEAR(shell.vertices[0].z(), 0, 1e-12);
  // The back is narrower by the clearance on either side.
  EXPECT_NEAR(shell.vertices[0].y() - shell.vertices[8].y(), kDigging.clearance, 1e-12);
}

TEST(BucketShape, IsThatOfTheShippedBucketAtItsSize) {
  // vehicles/ew180/model.sdf: the floor falls by 0.235 m over 0.2 m, and the profile is 0.63 m
  // deep.
  const Vec3 cut = cut_direction(kDigging, 1);
  EXPECT_NEAR(cut.x(), 0.648, 0.002);
  EXPECT_NEAR(cut.z(), -0.762, 0.002);
  EXPECT_NEAR(bounds(bucket_shell(kDigging, 1)).high.z(), 0.63, 0.001);
}

TEST(BucketShape, ShellIsWoundWithItsInsideInFront) {
  const TriangleMesh shell = bucket_shell(kTrenching, 1.2);
  EXPECT_FALSE(find_winding_clash(shell));
  const Vec3 inside(0.7, 0, 0.2);
  for (std::size_t t = 0; t < shell.triangles.size(); ++t)
    EXPECT_GT(shell.area_vector(t).dot(inside - shell.corner(t, 0)), 0) << t;
}

TEST(BucketShape, PictureIsMadeOfClosedBodies) {
  const TriangleMesh picture = bucket_picture(kDigging, 1.1, {5, 0.08, 0.15}, {Vec2(-0.29, 0.33)});
  ASSERT_EQ(picture.material_of.size(), picture.triangles.size());
  EXPECT_NO_THROW(require_valid(picture, "picture"));
  // An open edge would be refused.
  EXPECT_GT(solid_properties(picture).volume, 0);
  // The teeth reach ahead of the edge along the floor.
  EXPECT_GT(bounds(picture).high.x(), 1.4 + 0.15 * 0.5);
}

TEST(BucketShape, SaysThatNothingIsLeftBetweenThickPlates) {
  const auto [least, most] = heaped_capacities({0.2, 1.4, 0.1, 0.06});
  EXPECT_EQ(least, 0);
  EXPECT_EQ(most, 0);
}

}  // namespace
}  // namespace navvy::geometry
