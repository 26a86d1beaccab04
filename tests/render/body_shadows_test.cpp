// SPDX-License-Identifier: Apache-2.0
#include "render/body_shadows.h"

#include <gtest/gtest.h>

namespace navvy::render {
namespace {

/// A horizontal square of 1 m x 1 m, seen from both sides.
class BodyShadowsTest : public testing::Test {
 protected:
  BodyShadowsTest() {
    shape_.low = Vec3f(-0.5f, -0.5f, 0);
    shape_.high = Vec3f(0.5f, 0.5f, 0);
    const Vec3f a(-0.5f, -0.5f, 0), b(0.5f, -0.5f, 0), c(0.5f, 0.5f, 0), d(-0.5f, 0.5f, 0);
    shape_.open_triangles = {a, b, c, a, c, d};
    above_.to_sun = Vec3f::UnitZ();
  }
  PlacedShape at(float x, float y, float z) const {
    PlacedShape out{&shape_, Eigen::Matrix4f::Identity()};
    out.X_WS.topRightCorner<3, 1>() = Vec3f(x, y, z);
    return out;
  }

  Shape shape_;
  Lighting above_;
  BodyShadows shadows_;
};

TEST_F(BodyShadowsTest, GroupsBodiesThatStandTogether) {
  // The first and the third touch through the second; the fourth is 30 m away.
  shadows_.update({at(0, 0, 1), at(1.5f, 0, 1), at(3, 0, 1), at(30, 0, 1)}, {}, 0.05f, above_);
  ASSERT_EQ(shadows_.groups().size(), 2u);
  EXPECT_EQ(shadows_.groups()[0].bodies, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(shadows_.groups()[1].bodies, (std::vector<std::size_t>{3}));
  // The map of a group is as fine as the group is small.
  EXPECT_NEAR(shadows_.ground().texel(), 31.0f / 512, 0.005f);
  EXPECT_NEAR(shadows_.groups()[0].shadows->texel(), 4.0f / 512, 0.001f);
  EXPECT_NEAR(shadows_.groups()[1].shadows->texel(), 1.0f / 512, 0.0005f);
}

TEST_F(BodyShadowsTest, ABodyShadesAnotherGroupBelowIt) {
  shadows_.update({at(0, 0, 1), at(0, 0, 9)}, {}, 0.05f, above_);
  ASSERT_EQ(shadows_.groups().size(), 2u);
  const ShadowMap& low = *shadows_.groups()[0].shadows;
  EXPECT_EQ(low.sun_at(Vec3f(0, 0, 1), 0.1f), 0);
  EXPECT_EQ(low.sun_at(Vec3f(0, 0, 9), 0.1f), 1);
  // Depths are those of the upper one, at which r is 1.
  EXPECT_NEAR(low.depths()[ShadowMap::kSize * ShadowMap::kSize / 2 + ShadowMap::kSize / 2],
              low.plane_r().head<3>().dot(Vec3f(0, 0, 9)) + low.plane_r().w(), 1e-4f);
}

TEST_F(BodyShadowsTest, OneGroupUsesTheMapOfTheGround) {
  shadows_.update({at(0, 0, 1), at(1, 0, 1)}, {}, 0.05f, above_);
  ASSERT_EQ(shadows_.groups().size(), 1u);
  EXPECT_EQ(shadows_.groups()[0].shadows, &shadows_.ground());
}

TEST_F(BodyShadowsTest, KeepsItsMapsUntilSomethingMoves) {
  const std::vector<PlacedShape> bodies = {at(0, 0, 1)};
  shadows_.update(bodies, {}, 0.05f, above_);
  const std::uint64_t version = shadows_.ground().version();
  shadows_.update(bodies, {}, 0.05f, above_);
  EXPECT_EQ(shadows_.ground().version(), version);
  shadows_.update({at(0, 0.01f, 1)}, {}, 0.05f, above_);
  EXPECT_GT(shadows_.ground().version(), version);
}

TEST_F(BodyShadowsTest, WithoutCastersAllIsLit) {
  shadows_.update({}, {}, 0.05f, above_);
  EXPECT_TRUE(shadows_.ground().empty());
  EXPECT_TRUE(shadows_.groups().empty());
  shadows_.clear({at(0, 0, 1)}, above_);
  ASSERT_EQ(shadows_.groups().size(), 1u);
  EXPECT_EQ(shadows_.groups()[0].shadows->sun_at(Vec3f(0, 0, 0), 0), 1);
}

TEST(ShadowMapTest, ReachesOnlyWhereAShadowFalls) {
  // The sun overhead, and one caster in the corner of a map of 10 m.
  Lighting lighting;
  lighting.to_sun = Vec3f::UnitZ();
  ShadowMap map;
  map.begin(lighting, {0, 0, 0}, {10, 10, 2});
  map.add_triangle({1, 1, 2}, {2, 1, 2}, {1, 2, 2}, false);
  map.finish();
  EXPECT_TRUE(map.reaches({0, 0, -1}, {3, 3, 0}));
  EXPECT_FALSE(map.reaches({5, 5, -1}, {9, 9, 0})) << "on the map, but lit";
  EXPECT_FALSE(map.reaches({20, 20, -1}, {23, 23, 0})) << "beyond the map";
}

}  // namespace
}  // namespace navvy::render
