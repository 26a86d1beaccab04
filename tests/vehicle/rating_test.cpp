// SPDX-License-Identifier: Apache-2.0
// Tool forces and lift capacities compared with statics by hand, on a machine of simple numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "scene_io/loader.h"
#include "scene_io/shipped.h"
#include "values.h"
#include "vehicle/machines.h"
#include "vehicle/rating/lift_capacity.h"
#include "vehicle/rating/tool_force.h"

namespace navvy::vehicle {
namespace {

using testing::box_link;
using testing::revolute;

constexpr double kBaseMass = 10000, kBoomMass = 800, kStickMass = 400, kBucketMass = 300;
constexpr double kMass = kBaseMass + kBoomMass + kStickMass + kBucketMass + 4;
/// Efforts of boom and stick [N m], which have no cylinder.
constexpr double kBoomEffort = 300e3, kStickEffort = 200e3;

/// Sets the limits of a joint.
void limit(scene::Machine& machine, const std::string& name, double lower, double upper) {
  scene::Joint& joint = machine.joints[static_cast<std::size_t>(machine.joint_index(name))];
  joint.has_limits = true;
  joint.lower = lower;
  joint.upper = upper;
}

/// Sets the largest effort of a joint [N m].
void effort(scene::Machine& machine, const std::string& name, double most) {
  machine.joints[static_cast<std::size_t>(machine.joint_index(name))].effort = most;
}

void add_arm(scene::Machine& m) {
  const auto add = [&](const std::string& name, double x, double mass, double centre) {
    m.links.push_back(
        box_link(name, make_pose(x, 0, 2), mass, Vec3(centre, 0, 0), Vec3(1, 0.3, 0.3)));
    const int child = static_cast<int>(m.links.size()) - 1;
    // The first link of the arm is on the base, the others on each other.
    m.joints.push_back(
        revolute(name + "_joint", name == "boom" ? 0 : child - 1, child, -Vec3::UnitY()));
  };
  add("boom", 0, kBoomMass, 2);
  add("stick", 4, kStickMass, 1.5);
  add("bucket", 7, kBucketMass, 0.5);
  limit(m, "boom_joint", -1, 1);
  limit(m, "stick_joint", -2, 0);
  limit(m, "bucket_joint", -1.5, 0.6);
  effort(m, "boom_joint", kBoomEffort);
  effort(m, "stick_joint", kStickEffort);
  m.arm = {"", "boom_joint", "stick_joint", "bucket_joint"};
  scene::Cylinder cylinder;
  cylinder.name = "bucket_cylinder";
  cylinder.joint = "bucket_joint";
  cylinder.base_link = "stick";
  cylinder.rod_link = "bucket";
  // 1.2 m behind the pivot and 0.4 m above it.
  cylinder.p_base = Vec3(1.8, 0, 0);
  cylinder.p_rod = Vec3(0, 0, 0.4);
  cylinder.bore = 0.1;
  cylinder.rod = 0.06;
  cylinder.pressure = 20e6;
  m.cylinders.push_back(cylinder);
  scene::Bucket bucket;
  bucket.link = "bucket";
  bucket.p_tip = Vec3::UnitX();
  bucket.cut_direction = -Vec3::UnitZ();
  m.buckets.push_back(bucket);
}

/// Returns a base of 10 t on four wheels at x = +-1.5 and y = +-1, its centre in their middle, with
/// an arm ahead whose pivot is 2 m above the ground: boom 4 m, stick 3 m, edge 1 m from its pivot.
scene::Machine digger() {
  scene::Machine m;
  m.name = "digger";
  m.links.push_back(box_link("base", Pose::Identity(), kBaseMass, Vec3(0, 0, 1), Vec3(3, 2, 1)));
  for (const double x : {1.5, -1.5})
    for (const double y : {1.0, -1.0}) {
      const std::string name = "wheel_" + std::to_string(m.wheels.size());
      m.links.push_back(box_link(name, make_pose(x, y, 0.5), 1, Vec3::Zero(), Vec3(1, 0.2, 1)));
      m.joints.push_back(revolute(name, 0, static_cast<int>(m.links.size()) - 1, Vec3::UnitY()));
      scene::Wheel wheel;
      wheel.joint = name;
      wheel.radius = 0.5;
      wheel.friction = 0.8;
      m.wheels.push_back(wheel);
    }
  m.has_drive = true;
  scene::AckermannDrive drive;
  drive.brake_force = 1e7;
  m.drive = drive;
  add_arm(m);
  return m;
}

/// Moment of the weights about the line at `x` across the machine, arm straight ahead [N m].
double moment_about(double x) {
  return kGravity * ((kBaseMass + 4) * (0 - x) + kBoomMass * (2 - x) + kStickMass * (5.5 - x) +
                     kBucketMass * (7.5 - x));
}

TEST(ToolForce, BreakoutIsPressureTimesAreaTimesTheBestLever) {
  scene::Machine machine = digger();
  effort(machine, "boom_joint", 5e6);
  effort(machine, "stick_joint", 5e6);
  const ToolForceRating rating = rate_tool_force(machine, ToolForceKind::kBreakout);
  // The lever of a cylinder between two pins is largest when it is at a right angle to the shorter
  // distance, 0.4 m: sin q = (a^2 + b^2 - (a^2 - b^2)) / (2 a b) = b / a.
  const double force = 20e6 * kPi / 4 * 0.1 * 0.1 * 0.4 / 1.0;
  EXPECT_NEAR(rating.rated.hydraulic, force, 1e-5 * force);
  EXPECT_NEAR(rating.rated.bucket, std::asin(0.4 / 1.2), 0.01);
  EXPECT_EQ(rating.rated.circuit, "bucket_cylinder");
  EXPECT_DOUBLE_EQ(rating.rated.radius, 1);
  // No position has more.
  for (const RatedToolForce& one : rating.curve) {
    EXPECT_LE(one.hydraulic, rating.rated.hydraulic * (1 + 1e-9));
    const double q = one.bucket, l = std::sqrt(1.6 - 0.96 * std::sin(q));
    EXPECT_NEAR(one.working, 20e6 * kPi / 4 * 0.01 * 0.48 * std::cos(q) / l, 1e-6 * force);
  }
}

TEST(ToolForce, TheWorkingCircuitAloneHasMoreThanOneThatMustBeHeld) {
  // The stick holds 200 kN m at most, so the best position of the bucket is out of reach.
  const ToolForceRating rating = rate_tool_force(digger(), ToolForceKind::kBreakout);
  const double force = 20e6 * kPi / 4 * 0.1 * 0.1 * 0.4 / 1.0;
  EXPECT_NEAR(rating.alone.working, force, 1e-5 * force);
  EXPECT_LT(rating.rated.hydraulic, 0.99 * force);
  EXPECT_GE(rating.rated.hydraulic, rating.alone.hydraulic);
  EXPECT_EQ(rating.alone.circuit, "stick_joint");
}

TEST(ToolForce, AWeakCircuitThatHoldsLimitsTheForce) {
  scene::Machine machine = digger();
  // Straight ahead: the edge pushes up with a lever of 8 m about the boom's pivot, 4 m about the
  // stick's.
  effort(machine, "stick_joint", 100e3);
  const RatedToolForce straight = tool_force_at(machine, ToolForceKind::kBreakout, 0, 0, 0);
  EXPECT_NEAR(straight.hydraulic, 100e3 / 4, 1e-6);
  EXPECT_EQ(straight.circuit, "stick_joint");
  effort(machine, "boom_joint", 100e3);
  const RatedToolForce held = tool_force_at(machine, ToolForceKind::kBreakout, 0, 0, 0);
  EXPECT_NEAR(held.hydraulic, 100e3 / 8, 1e-6);
  EXPECT_EQ(held.circuit, "boom_joint");
}

TEST(ToolForce, TipsWhereTheMomentsAboutTheWheelsBalance) {
  // The edge pulls down, so the ground pushes the arm up with a lever of 8 + 1.5 m about the rear
  // wheels.
  const RatedToolForce up = tool_force_at(digger(), ToolForceKind::kBreakout, 0, 0, 0);
  EXPECT_NEAR(up.tipping, moment_about(-1.5) / 9.5, 1e-6);
  // Straight up it slips where it lifts off.
  EXPECT_NEAR(up.slipping, kMass * kGravity, 1e-6 * kMass * kGravity);
  EXPECT_NEAR(up.reach, 8, 1e-9);
  EXPECT_NEAR(up.height, 2, 1e-9);
}

TEST(ToolForce, SlipsAtTheFrictionOfItsWheelsAndInItsBrakes) {
  // The bucket points down by 1.2 rad, so its edge pulls towards the machine and down.
  constexpr double kDown = 1.2;
  scene::Machine machine = digger();
  const RatedToolForce pull = tool_force_at(machine, ToolForceKind::kBreakout, 0, 0, -kDown);
  const double level = std::sin(kDown), up = std::cos(kDown);
  // The reaction lifts the machine, so less weight remains on its wheels.
  const double slips = 0.8 * kMass * kGravity / (level + 0.8 * up);
  EXPECT_NEAR(pull.slipping, slips, 1e-9 * slips);
  // About the rear wheels: it lifts with the lever of the edge and pulls forward at its height.
  const double centre = 7 + 0.5 * std::cos(kDown);
  const double weights = moment_about(-1.5) + kGravity * kBucketMass * (centre - 7.5);
  const double lever = up * (7 + std::cos(kDown) + 1.5) - level * (2 - std::sin(kDown));
  EXPECT_NEAR(pull.tipping, weights / lever, 1e-9 * weights);
  scene::AckermannDrive weak;
  weak.brake_force = 500;
  machine.drive = weak;
  const RatedToolForce braked = tool_force_at(machine, ToolForceKind::kBreakout, 0, 0, -kDown);
  EXPECT_NEAR(braked.slipping, 500 / level, 1e-6);
  EXPECT_EQ(braked.limit(), ForceLimit::kSlipping);
  EXPECT_NEAR(braked.standing(), 500 / level, 1e-6);
}

TEST(ToolForce, TearOutIsTheSticksTorqueOverTheDistanceOfTheEdge) {
  scene::Machine machine = digger();
  effort(machine, "stick_joint", 30e3);
  const ToolForceRating rating = rate_tool_force(machine, ToolForceKind::kTearOut);
  // The bucket is where its breakout force is largest.
  const double q = std::asin(0.4 / 1.2), radius = std::hypot(3 + std::cos(q), std::sin(q));
  EXPECT_NEAR(rating.rated.radius, radius, 1e-3);
  EXPECT_NEAR(rating.rated.hydraulic, 30e3 / radius, 2e-3 * 30e3 / radius);
  EXPECT_EQ(rating.rated.circuit, "stick_joint");
  EXPECT_LE(rating.standing.standing(), rating.rated.hydraulic * (1 + 1e-9));
}

TEST(ToolForce, StandingIsTheLargestForceWithoutAnAnchor) {
  const scene::Machine machine = digger();
  const ToolForceRating rating = rate_tool_force(machine, ToolForceKind::kBreakout);
  EXPECT_GE(rating.standing.standing(), rating.rated.standing());
  for (int i = 0; i <= 8; ++i)
    for (int k = 0; k <= 8; ++k)
      for (int b = 0; b <= 8; ++b) {
        const RatedToolForce one = tool_force_at(machine, ToolForceKind::kBreakout, -1 + 0.25 * i,
                                                 -0.25 * k, -1.5 + 0.2625 * b);
        // Only positions ahead of the wheels count.
        if (one.reach < 1.5) continue;
        EXPECT_LE(one.standing(), rating.standing.standing() * (1 + 1e-3));
      }
}

TEST(ToolForce, AMachineWithoutAnArmOrALimitIsRefusedWithARemedy) {
  scene::Machine machine = digger();
  machine.arm = {};
  EXPECT_EQ(tool_force_fault(machine)->element, "navvy:arm");
  EXPECT_THROW(rate_tool_force(machine, ToolForceKind::kTearOut), InputError);
  machine = digger();
  effort(machine, "boom_joint", 1e9);
  const std::optional<Fault> fault = tool_force_fault(machine);
  ASSERT_TRUE(fault.has_value());
  EXPECT_NE(fault->text().find("boom_joint"), std::string::npos) << fault->text();
  EXPECT_NE(fault->text().find("navvy:cylinder"), std::string::npos) << fault->text();
  machine = digger();
  machine.buckets.clear();
  EXPECT_THROW(LiftChart(machine, false), InputError);
}

TEST(LiftChart, HydraulicCapacityIsTheBoomsMomentBalance) {
  LiftChart chart(digger(), false);
  // The pin 6 m ahead at the height of the boom's pivot: an isosceles-free triangle of 4, 3, 6.
  const double boom = std::acos((16 + 36 - 9) / 48.0),
               stick = std::acos((16 + 9 - 36) / 24.0) - kPi;
  const std::optional<LiftCapacity> at = chart.at(6, 2, 0);
  ASSERT_TRUE(at.has_value());
  EXPECT_NEAR(at->boom, boom, 1e-6);
  EXPECT_NEAR(at->stick, stick, 1e-6);
  const double arm = kBoomMass * 2 * std::cos(boom) +
                     kStickMass * (4 * std::cos(boom) + 1.5 * std::cos(boom + stick));
  const double by_boom = (kBoomEffort / kGravity - arm) / 6;
  // The stick holds the load on its own lever.
  const double lever = 3 * std::cos(boom + stick);
  const double by_stick = (kStickEffort / kGravity - kStickMass * lever / 2) / lever;
  EXPECT_LT(by_boom, by_stick);
  EXPECT_NEAR(at->hydraulic, by_boom, 1e-4 * by_boom);
  EXPECT_EQ(at->circuit, "boom_joint");
}

TEST(LiftChart, TippingLoadIsTheMomentBalanceAboutTheFrontWheels) {
  LiftChart chart(digger(), false);
  const std::optional<LiftCapacity> at = chart.at(6, 2, 0);
  ASSERT_TRUE(at.has_value());
  const double boom = at->boom, pitch = at->boom + at->stick;
  const double moment = (kBaseMass + 4) * 1.5 + kBoomMass * (1.5 - 2 * std::cos(boom)) +
                        kStickMass * (1.5 - 4 * std::cos(boom) - 1.5 * std::cos(pitch));
  EXPECT_NEAR(at->tipping, moment / 4.5, 1e-4 * moment / 4.5);
  EXPECT_NEAR(at->rated(), std::min(0.87 * at->hydraulic, 0.75 * at->tipping), 1e-9);
}

TEST(LiftChart, TheBucketsWeightReducesTheLoad) {
  const std::optional<LiftCapacity> bare = LiftChart(digger(), false).at(6, 2, 0),
                                    fitted = LiftChart(digger(), true).at(6, 2, 0);
  ASSERT_TRUE(bare && fitted);
  // Curled in to -1.5 rad, its centre is 0.5 m from the pin.
  const double ahead = 0.5 * std::cos(bare->boom + bare->stick - 1.5);
  EXPECT_NEAR(bare->hydraulic - fitted->hydraulic, kBucketMass * (6 + ahead) / 6, 0.1);
  EXPECT_NEAR(bare->tipping - fitted->tipping, kBucketMass * (4.5 + ahead) / 4.5, 0.1);
}

TEST(LiftChart, ReachesAsFarAsItsArmAndNoFarther) {
  LiftChart chart(digger(), false);
  // Straight, the arm is 7 m long; the pivot of the boom is 2 m above the ground.
  EXPECT_NEAR(*chart.max_reach(2), 7, 0.011);
  EXPECT_TRUE(chart.at(6.99, 2, 0).has_value());
  EXPECT_FALSE(chart.at(7.05, 2, 0).has_value());
  EXPECT_FALSE(chart.at(6.9, 6, 0).has_value());
  EXPECT_FALSE(chart.max_reach(20).has_value());
  // Without a swing the arm stays over the front.
  EXPECT_FALSE(chart.at(6, 2, 1).has_value());
}

TEST(LiftChart, FindsADirectionWhichLimitsAllowOnlyAfterATurn) {
  scene::Machine machine = scene_io::load_machine(scene_io::shipped_machines().at("ew180"));
  scene::Joint& swing =
      machine.joints[static_cast<std::size_t>(machine.joint_index(machine.arm.swing))];
  swing.has_limits = true;
  swing.lower = radians(-100);
  swing.upper = radians(200);
  LiftChart chart(machine, false);
  for (const double heading : {270.0, -170.0})
    EXPECT_TRUE(chart.at(6, 1.5, radians(heading)).has_value()) << heading;
  EXPECT_FALSE(chart.at(6, 1.5, radians(-130)).has_value());
}

TEST(LiftChart, ExcavatorsLiftLessOverTheSideAndAllRoundAreSymmetric) {
  for (const char* name : {"ew180", "ex180_tracked"}) {
    LiftChart chart(scene_io::load_machine(scene_io::shipped_machines().at(name)), false);
    for (const double reach : {4.5, 6.0, 7.0}) {
      const std::optional<LiftCapacity> front = chart.at(reach, 1.5, 0),
                                        left = chart.at(reach, 1.5, radians(90)),
                                        right = chart.at(reach, 1.5, radians(-90));
      ASSERT_TRUE(front && left && right) << name << " " << reach;
      EXPECT_LT(left->tipping, front->tipping);
      EXPECT_NEAR(left->tipping, right->tipping, 1e-6 * left->tipping);
      // The hydraulics do not depend on the swing.
      EXPECT_NEAR(left->hydraulic, front->hydraulic, 1e-6 * front->hydraulic);
    }
    EXPECT_GT(chart.at(4.5, 1.5, radians(90))->rated(), chart.at(7, 1.5, radians(90))->rated());
  }
}

}  // namespace
}  // namespace navvy::vehicle
