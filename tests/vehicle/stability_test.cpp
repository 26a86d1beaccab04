// SPDX-License-Identifier: Apache-2.0
#include "vehicle/stability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "paths.h"
#include "scene_io/loader.h"

namespace navvy::vehicle {
namespace {

const std::vector<Vec2> kSquare = {{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 1}};  // a foot in the middle is no corner

TEST(SupportMargin, IsTheDistanceToTheNearestEdgePositiveWithin) {
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {0.5, 1}), 0.5);
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {1, -0.25}), -0.25);
  // Beyond a corner the corner is nearest: 3, 4, 5.
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {5, 6}), -5);
}

TEST(SupportMargin, OfFeetInARowOrNoneIsNeverPositive) {
  EXPECT_DOUBLE_EQ(support_margin({{0, 0}, {1, 0}, {2, 0}}, {1, 0.5}), -0.5);
  EXPECT_LE(support_margin({{0, 0}, {1, 0}, {2, 0}}, {1, 0}), 0);
  EXPECT_LT(support_margin({}, {0, 0}), 0);
}

/// Level ground far below: nothing touches it.
class Below final : public GroundQuery {
 public:
  double height(double, double) const override { return -100; }
  Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
};

TEST(Stability, OfTheExcavatorFollowsItsTilt) {
  const scene::Machine machine = scene_io::load_machine(navvy::source_dir() + "/vehicles/ew180/model.sdf");
  double before = 10;
  for (const double roll : {0.0, 15.0, 30.0, 45.0}) {
    const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
    engine->add_machine(machine, make_pose(0, 0, 1, radians(roll), 0, 0.4));
    engine->step(1e-4, Below());
    const Stability stands = stability(machine, *engine, 0);
    ASSERT_TRUE(stands.free);
    EXPECT_NEAR(degrees(stands.tilt), roll, 0.1);  // it falls for 0.1 ms
    EXPECT_LT(stands.margin, before);
    before = stands.margin;
    // Half a track of 1.1 m and a centre of mass a metre over the ground: upright it stands, at 45 deg it does not.
    if (roll == 0) EXPECT_GT(stands.margin, 0.4);
    if (roll == 45) EXPECT_LT(stands.margin, 0);
  }
}

TEST(Stability, OfAMachineThatCannotTipSaysNothing) {
  scene::Machine machine = scene_io::load_machine(navvy::source_dir() + "/vehicles/ew180/model.sdf");
  machine.kinematic = true;
  const auto engine = make_kinematic_engine();
  engine->add_machine(machine, make_pose(0, 0, 1, radians(80), 0, 0));
  EXPECT_FALSE(stability(machine, *engine, 0).free);
}

}  // namespace
}  // namespace navvy::vehicle
