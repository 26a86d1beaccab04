// SPDX-License-Identifier: Apache-2.0
// Engine, gears and differentials on a cart of 2 t in the Bullet engine, compared with the closed
// forms of docs/machines.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <variant>

#include "core/saved_state.h"
#include "values.h"
#include "vehicle/drive/drive_line.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using Kind = scene::Differential::Kind;
using testing::flat;
using testing::run;
using testing::slope;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

scene::CombustionEngine diesel() {
  scene::CombustionEngine engine;
  engine.curve = {{100, 150}, {200, 180}, {300, 150}};
  engine.braking_torque = 40;
  engine.gears = {4, 2};
  engine.final_ratio = 10;
  engine.efficiency = 0.9;
  return engine;
}

scene::CombustionEngine source() {
  scene::CombustionEngine engine;
  engine.kind = scene::CombustionEngine::Kind::kSpeedSource;
  engine.max_speed = 300, engine.max_torque = 150;
  engine.gears = {20};
  return engine;
}

scene::Machine cart_with(const scene::CombustionEngine& engine,
                         const scene::Differential& axles = {}) {
  scene::Machine cart = testing::cart();
  auto& drive = std::get<scene::AckermannDrive>(cart.drive);
  drive.max_speed = 20;
  drive.engine = engine;
  drive.axles = axles;
  for (scene::Wheel& wheel : cart.wheels) wheel.rolling_resistance = 0;  // a separate torque
  return cart;
}

struct Rig {
  explicit Rig(scene::Machine of, double angle = 0)
      : machine(std::move(of)), engine(make_bullet_engine(kDown)) {
    engine->add_machine(machine, make_pose(0, 0, 0.02, 0, -angle));
  }
  double speed() const {
    return engine->link(0, 0).X_WL.linear().col(0).dot(engine->link(0, 0).v_WL);
  }
  double carrier() const { return 0.5 * (engine->wheel(0, 2).spin + engine->wheel(0, 3).spin); }
  double torque() const {
    return engine->wheel(0, 2).shaft_torque + engine->wheel(0, 3).shaft_torque;
  }
  /// Holds the chassis back by a spring and a damper; returns their force [N].
  double tie() {
    const LinkState at = engine->link(0, 0);
    const double force = -5e4 * at.X_WL.translation().x() - 2e4 * at.v_WL.x();
    engine->add_force(0, 0, Vec3(force, 0, 0), at.X_WL.translation() + Vec3(1.4, 0, 0.3));
    return -force;
  }
  scene::Machine machine;
  std::unique_ptr<PhysicsEngine> engine;
};

TEST(PowerTrain, DrivesInEachGearAtTheGovernedSpeed) {
  for (const int gear : {1, 2}) {
    Rig rig(cart_with(diesel()));
    rig.engine->set_drive(0, {50, 0, false, gear});
    run(*rig.engine, flat(), 10, kStep);
    const double expected = 300 * 0.525 / (10 * (gear == 1 ? 4 : 2));
    print_value("top speed in gear " + std::to_string(gear) + " [m/s]", rig.speed(),
                std::to_string(expected), "w r / (i g)");
    // 3 %: the loaded radius is 12 mm less than 525, the tyres slip a little.
    EXPECT_NEAR(rig.speed(), expected, 0.03 * expected);
    EXPECT_NEAR(rig.engine->power()->drive_engine(0).speed, 300, 0.01 * 300);
    EXPECT_EQ(rig.engine->power()->drive_engine(0).gear, gear);
  }
}

TEST(PowerTrain, PullsWithTorqueTimesRatioTimesEfficiencyByRadius) {
  Rig rig(cart_with(diesel()));
  rig.engine->set_drive(0, {5, 0, false, 2});
  double force = 0;
  run(*rig.engine, flat(), 6, kStep, [&](double) { force = rig.tie(); });
  const double torque = 20 * 0.9 * 150;
  EXPECT_LT(std::abs(rig.speed()), 0.01);
  EXPECT_NEAR(rig.torque(), torque, 1e-6 * torque);
  // The load on a rear tyre is some 5 kN: 12 mm of 525.
  print_value("drawbar pull at idle, the clutch slipping [N]", force,
              std::to_string(torque / 0.513), "i g eta T / r");
  EXPECT_NEAR(force, torque / 0.513, 0.03 * torque / 0.513);
  EXPECT_EQ(rig.engine->power()->drive_engine(0).speed, 100) << "it is not stalled";
  EXPECT_NEAR(rig.engine->power()->drive_engine(0).torque, 150, 1e-9);
}

TEST(PowerTrain, StaysBelowTheEngineCurve) {
  Rig rig(cart_with(diesel()));
  rig.engine->set_drive(0, {50, 0, false});
  const double rated = scene::rated_point(diesel()).speed * scene::rated_point(diesel()).torque;
  double most = 0;
  run(*rig.engine, flat(), 8, kStep, [&](double) {
    const CombustionEngineState state = rig.engine->power()->drive_engine(0);
    most = std::max(most, state.power);
    EXPECT_GE(state.speed, 100);
    // 1 %: the torque was computed for the speed at the step's start.
    EXPECT_LE(rig.torque() * rig.carrier(), 1.01 * 0.9 * std::max(state.power, 1.0));
  });
  print_value("largest power of the engine [kW]", most / 1e3, "45 at most", "T w at 300 rad/s");
  EXPECT_LE(most, rated * (1 + 1e-9));
  EXPECT_GT(most, 0.5 * rated);
}

TEST(PowerTrain, BrakesByItsGear) {
  // 6 deg draw with 2050 N; the first gear holds 40 / 0.9 x 40 / 0.51 = 3.5 kN, the second 1.7 kN.
  const double angle = radians(-6);
  for (const int gear : {1, 2}) {
    Rig rig(cart_with(diesel()), angle);
    rig.engine->set_drive(0, {2, 0, false, gear});
    run(*rig.engine, slope(angle), 8, kStep);
    if (gear == 1) EXPECT_NEAR(rig.speed(), 2, 0.1);
    if (gear == 2) EXPECT_GT(rig.speed(), 3);
    EXPECT_LT(rig.torque(), 0);
  }
}

TEST(PowerTrain, ClimbsInAGearThatPullsWithoutHunting) {
  // 18 deg require 6.1 kN; the second gear has 6.2 at most, the first twice that.
  const double angle = radians(18);
  Rig rig(cart_with(diesel()), angle);
  rig.engine->set_drive(0, {3, 0, false});
  int changes = 0, last = 1;
  run(*rig.engine, slope(angle), 10, kStep, [&](double) {
    const int gear = rig.engine->power()->drive_engine(0).gear;
    changes += gear != last;
    last = gear;
  });
  EXPECT_EQ(last, 1);
  EXPECT_EQ(changes, 0);
  EXPECT_NEAR(rig.speed(), 3, 0.15);
  // On the level it continues in the second gear.
  Rig level(cart_with(diesel()));
  level.engine->set_drive(0, {3, 0, false});
  run(*level.engine, flat(), 8, kStep);
  EXPECT_EQ(level.engine->power()->drive_engine(0).gear, 2);
  EXPECT_NEAR(level.speed(), 3, 0.1);
}

TEST(PowerTrain, ReversesItsDirection) {
  Rig rig(cart_with(diesel()));
  rig.engine->set_drive(0, {2, 0, false});
  run(*rig.engine, flat(), 4, kStep);
  rig.engine->set_drive(0, {-1.5, 0, false});
  run(*rig.engine, flat(), 8, kStep);
  EXPECT_NEAR(rig.speed(), -1.5, 0.06);
  EXPECT_GE(rig.engine->power()->drive_engine(0).speed, 100);
}

TEST(PowerTrain, ShaftsOfAnOpenDifferentialShareTorqueAndAddSpeeds) {
  for (const scene::CombustionEngine& about : {diesel(), source()}) {
    Rig rig(cart_with(about));
    const double wheelbase = std::get<scene::AckermannDrive>(rig.machine.drive).wheelbase;
    rig.engine->set_drive(0, {2, std::atan(wheelbase / 7), false});
    run(*rig.engine, flat(), 6, kStep);
    const WheelState left = rig.engine->wheel(0, 2), right = rig.engine->wheel(0, 3);
    EXPECT_GT(right.spin, 1.1 * left.spin) << "in a turn to the left";
    EXPECT_GT(left.shaft_torque, 0);
    EXPECT_NEAR(left.shaft_torque, right.shaft_torque, 0.01 * right.shaft_torque);
    const CombustionEngineState engine = rig.engine->power()->drive_engine(0);
    const GearedEngine gears(about, false);
    const double ratio = gears.ratio(engine.gear);
    EXPECT_NEAR(engine.speed, ratio * rig.carrier(), 0.01 * engine.speed);
    EXPECT_NEAR(rig.torque(), 0.9 * ratio * engine.torque, 0.01 * rig.torque());
  }
}

TEST(PowerTrain, ShaftsOfALimitedSlipDifferentialDifferByTwiceItsTorque) {
  // The left wheels on ice: the right one receives what the left one loses, half of 300 N m.
  scene::Machine cart = cart_with(diesel(), {Kind::kLimitedSlip, 300, 0});
  for (std::size_t w = 0; w < cart.wheels.size(); w += 2) cart.wheels[w].friction = 0.05;
  Rig rig(cart, radians(4));
  rig.engine->set_drive(0, {1.5, 0, false, 1});
  run(*rig.engine, slope(radians(4)), 4, kStep);
  const WheelState left = rig.engine->wheel(0, 2), right = rig.engine->wheel(0, 3);
  ASSERT_GT(left.spin, right.spin + 1) << "it slips";
  EXPECT_NEAR(right.shaft_torque - left.shaft_torque, 300, 3);
}

TEST(PowerTrain, ASpeedSourceTurnsTheDifferentialCarrierAsCommanded) {
  Rig rig(cart_with(source()));
  rig.engine->set_drive(0, {1.5, 0.2, false});
  run(*rig.engine, flat(), 4, kStep);
  EXPECT_NEAR(rig.carrier() * 0.525, 1.5, 1e-3 * 1.5) << "by the unloaded radius";
  EXPECT_NEAR(rig.engine->power()->drive_engine(0).speed, 20 * rig.carrier(),
              1e-3 * 20 * rig.carrier());
  // Blocked, it gives its largest torque and stops.
  Rig tied(cart_with(source()));
  tied.engine->set_drive(0, {1.5, 0, false});
  run(*tied.engine, flat(), 6, kStep, [&](double) { tied.tie(); });
  EXPECT_NEAR(tied.torque(), 20 * 0.9 * 150, 1);
  EXPECT_NEAR(tied.engine->power()->drive_engine(0).torque, 150, 0.1);
  EXPECT_NEAR(tied.speed(), 0, 0.02);
}

TEST(PowerTrain, ResumesEqual) {
  for (const scene::CombustionEngine& about : {diesel(), source()}) {
    const scene::Machine cart = cart_with(about, {Kind::kLimitedSlip, 100, 0.2});
    Rig whole(cart), resumed(cart);
    whole.engine->set_drive(0, {3, 0.2, false, 1});
    run(*whole.engine, flat(), 1, kStep);
    whole.engine->set_drive(0, {3, 0.2, false});
    run(*whole.engine, flat(), 0.5, kStep);
    load_saved(saved(*whole.engine), *resumed.engine);
    EXPECT_EQ(testing::digest(*resumed.engine), testing::digest(*whole.engine));
    EXPECT_EQ(resumed.torque(), whole.torque());
    EXPECT_EQ(resumed.engine->power()->drive_engine(0).torque,
              whole.engine->power()->drive_engine(0).torque);
    run(*whole.engine, flat(), 1.5, kStep);
    run(*resumed.engine, flat(), 1.5, kStep);
    EXPECT_EQ(testing::digest(*resumed.engine), testing::digest(*whole.engine));
  }
}

/// Returns the turning radius of a cart whose rear wheels are turned and whose front wheels are
/// steered individually; the largest change of the chassis' velocity within a step goes to `jump`.
double radius_of(double left_speed, double right_speed, double left_angle, double right_angle,
                 double& jump) {
  scene::Machine cart = testing::cart();
  for (const char* joint : {"rear_left_joint", "rear_right_joint"})
    cart.joints[static_cast<std::size_t>(cart.joint_index(joint))].effort = 4e3;
  Rig rig(cart);
  const auto command = [&](const std::string& joint, JointMode mode, double target) {
    rig.engine->set_joint(0, rig.machine.joint_index(joint), {mode, target});
  };
  rig.engine->set_drive(0, {0, 0, false});
  command("steer_front_left_joint", JointMode::kPosition, left_angle);
  command("steer_front_right_joint", JointMode::kPosition, right_angle);
  command("rear_left_joint", JointMode::kVelocity, left_speed);
  command("rear_right_joint", JointMode::kVelocity, right_speed);
  Vec3 last = rig.engine->link(0, 0).v_WL;
  double turned = 0, travel = 0;
  run(*rig.engine, flat(), 10, kStep, [&](double t) {
    const LinkState at = rig.engine->link(0, 0);
    jump = std::max(jump, (at.v_WL - last).norm());
    last = at.v_WL;
    if (t > 5) turned += at.w_WL.z() * kStep, travel += rig.speed() * kStep;
  });
  return travel / turned;
}

TEST(Ackermann, InputsThatDoNotFitUnderAndOversteerWithoutAJump) {
  // A radius of 8 m at the rear axle, 1 m/s in its middle.
  const double R = 8, L = 2.8, half = 0.97, w = 1 / 0.525;
  const double inner = std::atan(L / (R - half)), outer = std::atan(L / (R + half));
  double jump = 0;
  const double fits = radius_of(w * (1 - half / R), w * (1 + half / R), inner, outer, jump);
  EXPECT_NEAR(fits, R, 0.05 * R);
  // If the inner wheel drives too fast it pushes out of the turn; the outer one pushes inwards.
  const double under = radius_of(w * (1 + half / R), w * (1 - half / R), inner, outer, jump);
  const double over = radius_of(w * (1 - 3 * half / R), w * (1 + 3 * half / R), inner, outer, jump);
  EXPECT_GT(under, 1.05 * fits);
  EXPECT_LT(over, 0.97 * fits);
  // One front wheel straight: roughly the mean of both.
  const double straight = radius_of(w, w, inner, 0, jump);
  EXPECT_GT(straight, 1.3 * fits);
  print_value("radius with inputs that fit, under-, oversteer, one wheel straight [m]", fits,
              std::to_string(under) + ", " + std::to_string(over) + ", " + std::to_string(straight),
              "");
  print_value("largest change of velocity within a step [m/s]", jump, "0.25 at most", "");
  EXPECT_LT(jump, 0.25);
}

}  // namespace
}  // namespace navvy::vehicle
