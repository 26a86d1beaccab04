// SPDX-License-Identifier: Apache-2.0
#include "vehicle/stability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "paths.h"
#include "scene_io/loader.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

// A support in the middle is no corner.
const std::vector<Vec2> kSquare = {{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 1}};

TEST(SupportMargin, IsTheDistanceToTheNearestEdgePositiveWithin) {
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {0.5, 1}), 0.5);
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {1, -0.25}), -0.25);
  // Beyond a corner the corner is nearest: 3, 4, 5.
  EXPECT_DOUBLE_EQ(support_margin(kSquare, {5, 6}), -5);
}

TEST(SupportMargin, IsUndefinedForCollinearOrMissingSupports) {
  EXPECT_EQ(support_margin({{0, 0}, {1, 0}, {2, 0}}, {1, 0.5}), 0);
  EXPECT_EQ(support_margin({{0, 0}, {1, 0}}, {1, 0}), 0);
  EXPECT_EQ(support_margin({}, {0, 0}), 0);
}

TEST(TippingLoad, IsTheMomentBalanceOverTheWeakestEdge) {
  // 2 m wide, 3 m long; 18 t, 0.4 m left of its middle.
  const std::vector<Vec2> points = {{0, -1}, {3, -1}, {3, 1}, {0, 1}};
  const Vec2 centre(1.5, 0.4);
  const TippingLoad side = tipping_load(points, centre, 18000, Vec2(1.5, 7));
  EXPECT_NEAR(side.load, 18000 * 0.6 / 6, 1e-9);
  EXPECT_TRUE(side.outward.isApprox(Vec2(0, 1)));
  const TippingLoad front = tipping_load(points, centre, 18000, Vec2(8, 0));
  EXPECT_NEAR(front.load, 18000 * 1.5 / 5, 1e-9);
  EXPECT_TRUE(front.outward.isApprox(Vec2(1, 0)));
  // Over a corner it tips over the weaker edge.
  EXPECT_NEAR(tipping_load(points, centre, 18000, Vec2(6, 4)).load,
              std::min(18000 * 1.5 / 3, 18000 * 0.6 / 3), 1e-9);
  // Inside the supports no load tips it; a machine that tips by itself carries none.
  EXPECT_EQ(tipping_load(points, centre, 18000, Vec2(2, 0)).load, kNoTippingLoad);
  EXPECT_EQ(tipping_load(points, Vec2(1, 1.2), 18000, Vec2(2, 0)).load, 0);
  EXPECT_EQ(tipping_load({{0, 0}, {1, 0}}, Vec2(0.5, 0), 18000, Vec2(2, 0)).load, 0);
}

/// Level ground far below, without contact.
class Below final : public GroundQuery {
 public:
  double height(double, double) const override { return -100; }
  Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
};

TEST(Stability, OfTheExcavatorFollowsItsTilt) {
  const scene::Machine machine =
      scene_io::load_machine(navvy::source_dir() + "/vehicles/ew180/model.sdf");
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
    // Half a track width of 1.1 m and a centre of mass a metre above the ground: upright it stands,
    // at 45 deg it does not.
    if (roll == 0) EXPECT_GT(stands.margin, 0.4);
    if (roll == 45) EXPECT_LT(stands.margin, 0);
  }
}

/// Two wheels of 0.1 m, track width 0.4 m, under a box of 40 kg whose middle is 0.1 m ahead of
/// their axle.
scene::Machine two_wheels() {
  scene::Machine robot;
  robot.name = "robot";
  robot.links.push_back(
      testing::box_link("base", make_pose(0, 0, 0.1), 40, Vec3(0.1, 0, 0.05), Vec3(0.5, 0.3, 0.1)));
  robot.links[0].collisions.clear();
  for (const double y : {0.2, -0.2}) {
    const std::string name = y > 0 ? "left" : "right";
    robot.links.push_back(
        testing::box_link(name, make_pose(0, y, 0.1), 3, Vec3::Zero(), Vec3(0.2, 0.05, 0.2)));
    robot.joints.push_back(
        testing::revolute(name, 0, static_cast<int>(robot.links.size()) - 1, Vec3::UnitY()));
    scene::Wheel wheel;
    wheel.joint = name;
    wheel.radius = 0.1;
    wheel.width = 0.05;
    robot.wheels.push_back(wheel);
  }
  return robot;
}

/// Adds a ball of this radius on a separate link [m].
void add_castor(scene::Machine& robot, double radius, double x) {
  robot.links.push_back(
      testing::box_link("castor", make_pose(x, 0, radius), 1, Vec3::Zero(), Vec3::Constant(0.05)));
  scene::Collision ball;
  ball.geometry.kind = scene::Geometry::Kind::kSphere;
  ball.geometry.radius = radius;
  robot.links.back().collisions = {ball};
  scene::Joint joint =
      testing::revolute("castor", 0, static_cast<int>(robot.links.size()) - 1, Vec3::UnitY());
  joint.type = scene::Joint::Type::kBall;
  joint.X_LcJ = Pose::Identity();
  robot.joints.push_back(joint);
}

TEST(Stability, CountsABallAsASupportAndInventsNone) {
  const auto standing = [](const scene::Machine& robot, double pitch) {
    const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
    engine->add_machine(robot, make_pose(0, 0, 0.1, 0, pitch, 0));
    engine->step(1e-4, Below());
    return stability(robot, *engine, 0);
  };
  // Two wheels span no area: it may balance, so only its tilt counts.
  const Stability balances = standing(two_wheels(), 0);
  EXPECT_TRUE(balances.free);
  EXPECT_EQ(balances.margin, 0);
  // With a ball 0.3 m ahead it stands: between axle and ball, nearest to the sides of that
  // triangle.
  scene::Machine robot = two_wheels();
  add_castor(robot, 0.05, 0.3);
  const Stability stands = standing(robot, 0);
  EXPECT_GT(stands.margin, 0.05);
  EXPECT_LT(stands.margin, 0.12);
  EXPECT_GT(standing(robot, radians(5)).margin, 0.04);
  // A ball behind carries no load ahead of the wheels.
  scene::Machine wrong = two_wheels();
  add_castor(wrong, 0.05, -0.3);
  EXPECT_LT(standing(wrong, 0).margin, -0.05);
  // A ball high above the ground is no support.
  scene::Machine high = two_wheels();
  add_castor(high, 0.05, 0.3);
  high.links.back().collisions[0].X_LC = make_pose(0, 0, 0.2);
  EXPECT_EQ(standing(high, 0).margin, 0);
}

/// The shipped excavator with its arm over the side, on a plane that falls in that direction by
/// `angle` [rad].
struct Lifting {
  explicit Lifting(double angle)
      : hill([t = std::tan(angle)](double, double y) { return -t * y; }),
        machine(testing::ew180(0.55, -1.0, -1.6, radians(90))),
        engine(make_bullet_engine(Vec3(0, 0, -kGravity))) {
    engine->add_machine(machine, make_pose(0, 0, 0.01, -angle, 0, 0));
    testing::run(*engine, hill, 3, 1.0 / 600);
  }
  Vec3 pin() const { return engine->link(0, machine.link_index("bucket")).X_WL.translation(); }
  Stability now() const { return stability(machine, *engine, 0); }

  testing::FunctionGround hill;
  scene::Machine machine;
  std::unique_ptr<PhysicsEngine> engine;
};

TEST(Stability, ReportsTheLoadThatTipsItOnTheFlatAndOnASlope) {
  for (const double angle : {0.0, radians(6)}) {
    Lifting rig(angle);
    const Stability before = rig.now();
    EXPECT_NEAR(before.tipping_heading, radians(90), radians(2));
    // Closed form: sum of m (edge - y) over all links, over the load's lever; on the slope all
    // rotated with it. The edge is the line of the left wheels' contacts.
    Vec3 centre = Vec3::Zero();
    double mass = 0;
    for (std::size_t i = 0; i < rig.machine.links.size(); ++i) {
      const scene::Link& link = rig.machine.links[i];
      centre += link.mass * (rig.engine->link(0, static_cast<int>(i)).X_WL * link.p_LCom);
      mass += link.mass;
    }
    centre /= mass;
    const Vec3 wheel = rig.engine->wheel(0, 2).X_WWheel.translation();
    const double roll = before.tilt;
    const double edge = wheel.y() - 0.525 * std::sin(roll);
    const double expected = mass * (edge - centre.y()) / (rig.pin().y() - edge);
    EXPECT_NEAR(before.tipping_load, expected, 0.02 * expected);
    // The load grows by 100 kg/s until the uphill wheels carry nothing.
    double load = 0, tipped = 0;
    testing::run(*rig.engine, rig.hill, 40, 2.0 / 600, [&](double) {
      if (tipped > 0) return;
      load += 100 * 2.0 / 600;
      rig.engine->add_force(0, rig.machine.link_index("bucket"), Vec3(0, 0, -kGravity * load),
                            rig.pin());
      if (rig.engine->wheel(0, 1).force_W.z() <= 0 && rig.engine->wheel(0, 3).force_W.z() <= 0)
        tipped = load;
    });
    print_value("tipping load [kg]", tipped, std::to_string(before.tipping_load) + " +-6 %",
                "reported before");
    // 6 %: it leans on its tyres by a degree before it tips; the reported load is that of the
    // present lean.
    EXPECT_NEAR(tipped, before.tipping_load, 0.06 * before.tipping_load);
  }
}

TEST(Stability, LoadedMarginIncludesTheLoadOnTheArm) {
  for (const double angle : {0.0, radians(6)}) {
    Lifting rig(angle);
    // Unloaded, the centre of pressure is below the centre of mass.
    EXPECT_NEAR(rig.now().loaded_margin, rig.now().margin, 0.02);
    const double load = 600;
    testing::run(*rig.engine, rig.hill, 4, 1.0 / 600, [&](double) {
      rig.engine->add_force(0, rig.machine.link_index("bucket"), Vec3(0, 0, -kGravity * load),
                            rig.pin());
    });
    const Stability stands = rig.now();
    // Both weights about the weakest edge: (M d - m l) / (M + m), with m_tip = M d / l.
    const double d = stands.margin, l = 18000 * d / stands.tipping_load;
    const double expected = (18000 * d - load * l) / (18000 + load);
    print_value("margin with 600 kg over the side [m]", stands.loaded_margin,
                std::to_string(expected), "moment balance");
    // 0.03 m: both tyres of a pair carry, so the ground's force is not in the middle between them.
    EXPECT_NEAR(stands.loaded_margin, expected, 0.03);
    EXPECT_LT(stands.loaded_margin, d - 0.1);
  }
}

TEST(Stability, IsUndefinedForAMachineThatCannotTip) {
  scene::Machine machine =
      scene_io::load_machine(navvy::source_dir() + "/vehicles/ew180/model.sdf");
  machine.kinematic = true;
  const auto engine = make_kinematic_engine();
  engine->add_machine(machine, make_pose(0, 0, 1, radians(80), 0, 0));
  EXPECT_FALSE(stability(machine, *engine, 0).free);
}

}  // namespace
}  // namespace navvy::vehicle
