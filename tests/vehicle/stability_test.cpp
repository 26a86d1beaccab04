// SPDX-License-Identifier: Apache-2.0
#include "vehicle/stability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "paths.h"
#include "scene_io/loader.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

const std::vector<Vec2> kSquare = {{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 1}};  // a foot in the middle is no corner

TEST(SupportMargin, IsTheDistanceToTheNearestEdgePositiveWithin) {
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {0.5, 1}), 0.5);
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {1, -0.25}), -0.25);
  // Beyond a corner the corner is nearest: 3, 4, 5.
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {5, 6}), -5);
}

TEST(SupportMargin, OfFeetInARowOrNoneIsNothing) {
  EXPECT_EQ(support_margin({{0, 0}, {1, 0}, {2, 0}}, {1, 0.5}), 0);
  EXPECT_EQ(support_margin({{0, 0}, {1, 0}}, {1, 0}), 0);
  EXPECT_EQ(support_margin({}, {0, 0}), 0);
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

/// Two wheels of 0.1 m on a track of 0.4 m under a box of 40 kg, whose middle is 0.1 m ahead of their axle.
scene::Machine two_wheels() {
  scene::Machine robot;
  robot.name = "robot";
  robot.links.push_back(testing::box_link("base", make_pose(0, 0, 0.1), 40, Vec3(0.1, 0, 0.05), Vec3(0.5, 0.3, 0.1)));
  robot.links[0].collisions.clear();
  for (const double y : {0.2, -0.2}) {
    const std::string name = y > 0 ? "left" : "right";
    robot.links.push_back(testing::box_link(name, make_pose(0, y, 0.1), 3, Vec3::Zero(), Vec3(0.2, 0.05, 0.2)));
    robot.joints.push_back(testing::revolute(name, 0, static_cast<int>(robot.links.size()) - 1, Vec3::UnitY()));
    scene::Wheel wheel;
    wheel.joint = name;
    wheel.radius = 0.1;
    wheel.width = 0.05;
    robot.wheels.push_back(wheel);
  }
  return robot;
}

/// A ball of this radius on a link of its own [m].
void add_castor(scene::Machine& robot, double radius, double x) {
  robot.links.push_back(testing::box_link("castor", make_pose(x, 0, radius), 1, Vec3::Zero(), Vec3::Constant(0.05)));
  scene::Collision ball;
  ball.geometry.kind = scene::Geometry::Kind::kSphere;
  ball.geometry.radius = radius;
  robot.links.back().collisions = {ball};
  scene::Joint joint = testing::revolute("castor", 0, static_cast<int>(robot.links.size()) - 1, Vec3::UnitY());
  joint.type = scene::Joint::Type::kBall;
  joint.X_LcJ = Pose::Identity();
  robot.joints.push_back(joint);
}

TEST(Stability, CountsABallAsAFootAndMakesNoneUp) {
  const auto standing = [](const scene::Machine& robot, double pitch) {
    const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
    engine->add_machine(robot, make_pose(0, 0, 0.1, 0, pitch, 0));
    engine->step(1e-4, Below());
    return stability(robot, *engine, 0);
  };
  // Two wheels span no area: it may balance, only its tilt tells.
  const Stability balances = standing(two_wheels(), 0);
  EXPECT_TRUE(balances.free);
  EXPECT_EQ(balances.margin, 0);
  // With a ball 0.3 m ahead it stands: between axle and ball, nearest to the sides of that triangle.
  scene::Machine robot = two_wheels();
  add_castor(robot, 0.05, 0.3);
  const Stability stands = standing(robot, 0);
  EXPECT_GT(stands.margin, 0.05);
  EXPECT_LT(stands.margin, 0.12);
  EXPECT_GT(standing(robot, radians(5)).margin, 0.04);
  // A ball behind bears nothing of what is ahead.
  scene::Machine wrong = two_wheels();
  add_castor(wrong, 0.05, -0.3);
  EXPECT_LT(standing(wrong, 0).margin, -0.05);
  // One that is high above the ground is no foot.
  scene::Machine high = two_wheels();
  add_castor(high, 0.05, 0.3);
  high.links.back().collisions[0].X_LC = make_pose(0, 0, 0.2);
  EXPECT_EQ(standing(high, 0).margin, 0);
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
