// SPDX-License-Identifier: Apache-2.0
#include "geometry/bucket_profile.h"

#include <gtest/gtest.h>

#include "geometry/bucket_shape.h"
#include "geometry/topology.h"

namespace navvy::geometry {
namespace {

const BucketSize kSize{1.05, 1.4, 0.03, 0.0};

TEST(BucketProfile, OfAMeshFindsEdgeMouthAndCapacity) {
  const auto profile = find_bucket_profile(bucket_picture(kSize, 1, {}, {Vec2(-0.29, 0.33)}));
  ASSERT_TRUE(profile);
  // The bar on the edge is 36 mm thick.
  EXPECT_NEAR((profile->points[0] - Vec2(1.4, 0)).norm(), 0, 0.02);
  EXPECT_NEAR(profile->y_high - profile->y_low, 1.05, 1e-9);
  const Vec3 cut = cut_direction(kSize, 1);
  EXPECT_GT(cut_direction(*profile).dot(Vec2(cut.x(), cut.z())), 0.99);
  EXPECT_LT(opening(*profile).y(), -0.99);
  // The outer profile holds what is between the plates, and the plates.
  const double inside = heaped_capacity(kSize, 1);
  EXPECT_GT(heaped_capacity(*profile), inside);
  EXPECT_LT(heaped_capacity(*profile), 1.2 * inside);
}

TEST(BucketProfile, DoesNotDependOnTheSideOfTheMouth) {
  TriangleMesh mesh = bucket_picture(kSize, 1, {}, {});
  // Turned about the pin by 200 deg, the mouth opens upwards and the edge is behind.
  const Pose X = make_pose(0, 0, 0, 0, radians(200), 0);
  for (Vec3& v : mesh.vertices) v = X * v;
  const auto profile = find_bucket_profile(mesh);
  ASSERT_TRUE(profile);
  const Vec3 edge = X * Vec3(1.4, 0, 0), up = X * Vec3(0, 0, -1);
  EXPECT_NEAR((profile->points[0] - Vec2(edge.x(), edge.z())).norm(), 0, 0.02);
  EXPECT_GT(opening(*profile).dot(Vec2(up.x(), up.z())), 0.98);
}

TEST(BucketProfile, MakesAShellWoundInwards) {
  for (const double turn : {0.0, 2.0}) {
    TriangleMesh mesh = bucket_picture(kSize, 1, {}, {});
    for (Vec3& v : mesh.vertices) v = make_pose(0, 0, 0, 0, turn, 0) * v;
    const auto profile = find_bucket_profile(mesh);
    ASSERT_TRUE(profile);
    const TriangleMesh shell = shell_of(*profile);
    EXPECT_FALSE(find_winding_clash(shell));
    const Vec3 inside = make_pose(0, 0, 0, 0, turn, 0) * Vec3(0.7, 0, 0.2);
    for (std::size_t t = 0; t < shell.triangles.size(); ++t)
      EXPECT_GT(shell.area_vector(t).dot(inside - shell.corner(t, 0)), 0) << t;
  }
}

TEST(BucketProfile, OfABlockIsNone) {
  TriangleMesh box;
  for (int i = 0; i < 8; ++i)
    box.vertices.emplace_back(i & 1 ? 1 : 0, i & 2 ? 0.5 : -0.5, i & 4 ? 0.7 : 0);
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  EXPECT_FALSE(find_bucket_profile(box));
  EXPECT_FALSE(find_bucket_profile({}));
}

}  // namespace
}  // namespace navvy::geometry
