// SPDX-License-Identifier: Apache-2.0
// The machine on its wheels: driving, steering, braking, trenches, heaps, pushes.
#include <gtest/gtest.h>

#include <cmath>

#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::cart;
using testing::ew180;
using testing::flat;
using testing::FunctionGround;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

/// Returns the radius of the circle through three points in the plane.
double circle_radius(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area2 = std::abs((b - a).head<2>().x() * (c - a).y() - (b - a).y() * (c - a).x());
  return (b - a).head<2>().norm() * (c - b).head<2>().norm() * (a - c).head<2>().norm() /
         (2 * area2);
}

TEST(BulletDrive, StaysAtRestOnItsTyres) {
  const scene::Machine m = ew180();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  run(*engine, ground, 4, kStep);
  const Vec3 before = engine->link(0, 0).X_WL.translation();
  run(*engine, ground, 5, kStep);
  // A hundredth of a millimetre: no creep.
  EXPECT_LT((engine->link(0, 0).X_WL.translation() - before).norm(), 1e-5);
  double load = 0;
  for (int w = 0; w < 4; ++w) load += engine->wheel(0, w).force_W.z();
  EXPECT_NEAR(load, 18000 * kGravity, 1e-3 * 18000 * kGravity);
  EXPECT_NEAR(engine->accounts()->ground_impulse(0).z(), 18000 * kGravity * kStep,
              1e-3 * 18000 * kGravity * kStep);
}

TEST(BulletDrive, TurnsOnTheAckermannRadiusAtWalkingSpeed) {
  for (const double radius : {6.0, -9.0}) {
    const scene::Machine m = ew180();
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(m, Pose::Identity());
    engine->set_drive(
        0, {1.2, std::atan(std::get<scene::AckermannDrive>(m.drive).wheelbase / radius), false});
    const auto ground = flat();
    run(*engine, ground, 4, kStep);
    Vec3 p[3];
    for (Vec3& at : p) {
      at = engine->link(0, 0).X_WL.translation();  // middle of the rear axle
      run(*engine, ground, 3, kStep);
    }
    const double measured = circle_radius(p[0], p[1], p[2]);
    print_value("radius of the turn [m]", measured, std::to_string(std::abs(radius)) + " +-3 %",
                "Ackermann [docs/validation.md, Machines]");
    EXPECT_NEAR(measured, std::abs(radius), 0.03 * std::abs(radius));
    EXPECT_EQ(engine->link(0, 0).w_WL.z() > 0, radius > 0);
    // The open differential: both wheels turn, the outer one faster.
    const double left = engine->wheel(0, 2).spin, right = engine->wheel(0, 3).spin;
    EXPECT_EQ(left<right, radius> 0);
  }
}

TEST(BulletDrive, KeepsTheCommandedSpeed) {
  for (const double angle : {0.0, 8.0}) {
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(ew180(), make_pose(0, 0, 0, 0, -radians(angle)));
    engine->set_drive(0, {1.0, 0, false});
    const auto ground = testing::slope(radians(angle));
    double fastest = 0;
    run(*engine, ground, 6, kStep,
        [&](double) { fastest = std::max(fastest, engine->link(0, 0).v_WL.norm()); });
    // 4 %: the governor controls the speed of the wheels; pulling 25 kN uphill two twins slip by 2
    // %.
    EXPECT_NEAR(engine->link(0, 0).v_WL.norm(), 1.0, 0.04) << angle;
    EXPECT_LT(fastest, 1.2) << angle;
  }
}

TEST(BulletDrive, StopsAndHoldsOnASlopeWithoutCreep) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(ew180(), make_pose(0, 0, 0, 0, -radians(15)));
  const auto ground = testing::slope(radians(15));
  engine->set_drive(0, {0.8, 0, false});
  run(*engine, ground, 3, kStep);
  engine->set_drive(0, {0, 0, true});
  run(*engine, ground, 3, kStep);
  const Vec3 before = engine->link(0, 0).X_WL.translation();
  run(*engine, ground, 10, kStep);
  // 0.1 mm in 10 s.
  EXPECT_LT((engine->link(0, 0).X_WL.translation() - before).norm(), 1e-4);
}

TEST(BulletDrive, SlidesDownWhereFrictionCannotHold) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(testing::with_grip(cart(), 0.3), make_pose(0, 0, 0, 0, -radians(20)));
  const auto ground = testing::slope(radians(20));
  run(*engine, ground, 1, kStep);
  const double v0 = engine->link(0, 0).v_WL.norm();
  run(*engine, ground, 1, kStep);
  const double expected = kGravity * (std::sin(radians(20)) - 0.3 * std::cos(radians(20)));
  // 2 %: the body still oscillates on its springs.
  EXPECT_NEAR(engine->link(0, 0).v_WL.norm() - v0, expected, 0.02 * kGravity);
}

TEST(BulletDrive, PushAtTheEdgeSlidesTheMachineOnMu03) {
  const scene::Machine m = testing::with_grip(ew180(), 0.3);
  const double hold = 0.3 * 18000 * kGravity;
  for (const double share : {0.9, 1.1}) {
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(m, Pose::Identity());
    const auto ground = flat();
    run(*engine, ground, 2, kStep);
    const auto push = [&](double part) {
      engine->add_force(0, 0, Vec3(-part * share * hold, 0, 0),
                        engine->link(0, 0).X_WL * Vec3(3.5, 0, 0.5));
    };
    const Vec3 before = engine->link(0, 0).X_WL.translation();
    // Applied slowly, so that the stretching bristles do not oscillate.
    for (int i = 0; i < 1200; ++i) {
      push(i / 1200.0);
      engine->step(kStep, ground);
    }
    const double v0 = engine->link(0, 0).v_WL.head<2>().norm();
    run(*engine, ground, 2, kStep, [&](double) { push(1); });
    if (share < 1) {
      // The bristles stretch: mu N / k = 53 kN / (4 x 1.28e6 N/m) = 10 mm, and the body leans.
      EXPECT_LT((engine->link(0, 0).X_WL.translation() - before).head<2>().norm(), 0.02);
      EXPECT_LT(engine->link(0, 0).v_WL.norm(), 1e-4);
    } else {
      const double expected = 0.1 * 0.3 * kGravity * 2;
      // 3 %: remaining oscillation.
      EXPECT_NEAR(engine->link(0, 0).v_WL.head<2>().norm() - v0, expected, 0.03 * expected);
    }
  }
}

TEST(BulletDrive, DropsIntoATrenchWithoutBeingLaunched) {
  // One bucket wide, 0.8 m deep, across the path; the chassis touches its edges.
  const FunctionGround ground([](double x, double) {
    return x > 5 && x < 6.05 ? -0.8 * std::min({1.0, (x - 5) / 0.1, (6.05 - x) / 0.1}) : 0.0;
  });
  auto engine = make_bullet_engine(kDown);
  const scene::Machine m = ew180();
  engine->add_machine(m, Pose::Identity());
  engine->set_drive(0, {0.8, 0, false});
  double lowest = 1, fastest = 0;
  run(*engine, ground, 8, kStep, [&](double) {
    const LinkState chassis = engine->link(0, 0);
    lowest = std::min(lowest, (chassis.X_WL * Vec3(2.8, 0, 0)).z());
    fastest = std::max({fastest, chassis.v_WL.z(), engine->accounts()->momentum(0).z() / 18000});
  });
  EXPECT_LT(fastest, 1.0);   // upwards: rear axle and centre of mass
  EXPECT_LT(lowest, -0.25);  // the front wheels are in it
}

TEST(BulletDrive, HeapLiftsAWheelWithoutLaunchingIt) {
  const FunctionGround ground(
      [](double x, double y) { return y > 0 ? std::max(0.0, 0.3 - 0.4 * std::abs(x - 5)) : 0.0; });
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(ew180(), Pose::Identity());
  engine->set_drive(0, {1.0, 0, false});
  double fastest = 0, front = 0, rear = 0, right = 0;
  run(*engine, ground, 9, kStep, [&](double) {
    for (int w = 0; w < 4; ++w) fastest = std::max(fastest, std::abs(engine->wheel(0, w).v_W.z()));
    front = std::max(front, engine->wheel(0, 0).X_WWheel.translation().z());
    right = std::max(right, engine->wheel(0, 1).X_WWheel.translation().z());
    rear = std::max(rear, engine->wheel(0, 2).X_WWheel.translation().z());
  });
  EXPECT_LT(fastest, 1.0);
  EXPECT_GT(front, 0.525 + 0.2);
  EXPECT_GT(rear, 0.525 + 0.2);
  EXPECT_LT(right, 0.525 + 0.05);
  EXPECT_GT(engine->link(0, 0).X_WL.translation().x(), 6);  // over it
}

TEST(BulletDrive, GroundRaisedUnderAWheelLiftsItSlowly) {
  double heap = 0;
  const FunctionGround ground(
      [&](double x, double y) { return std::hypot(x - 2.8, y - 1) < 0.7 ? heap : 0.0; });
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(ew180(), Pose::Identity());
  run(*engine, ground, 1, kStep);
  heap = 0.5;
  double fastest = 0;
  run(*engine, ground, 3, kStep, [&](double) {
    for (int w = 0; w < 4; ++w) fastest = std::max(fastest, std::abs(engine->wheel(0, w).v_W.z()));
    fastest = std::max(fastest, std::abs(engine->link(0, 0).v_WL.z()));
  });
  EXPECT_LT(fastest, 1.0);
  EXPECT_GT(engine->wheel(0, 0).X_WWheel.translation().z(), 0.85);
}

TEST(BulletDrive, TrailerWheelsTurnFreelyAndMotorsObeySetJoint) {
  scene::Machine m = cart();
  m.has_drive = false;
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  run(*engine, ground, 0.5, kStep);
  engine->apply_impulse(0, 0, Vec3(2000, 0, 0), Vec3::Zero(),
                        engine->link(0, 0).X_WL * Vec3(1.4, 0, 0.6));
  run(*engine, ground, 0.5, kStep);
  const double rolling = engine->link(0, 0).v_WL.x();
  EXPECT_GT(rolling, 0.5);
  EXPECT_LT(rolling, 1.0);  // 2000 kg at 2000 N s, less the wheels' spin and rolling resistance
  // A manual differential drive: the rear wheels at different speeds turn the cart.
  for (const char* name : {"front_left_joint", "front_right_joint"})
    engine->set_joint(0, m.joint_index(name), {JointMode::kFree, 0});
  engine->set_joint(0, m.joint_index("rear_left_joint"), {JointMode::kVelocity, 2});
  engine->set_joint(0, m.joint_index("rear_right_joint"), {JointMode::kVelocity, 2.2});
  run(*engine, ground, 3, kStep);
  EXPECT_GT(engine->link(0, 0).w_WL.z(), 0.005);
  EXPECT_NEAR(engine->joint(0, m.joint_index("rear_left_joint")).velocity, 2, 0.01);
}

}  // namespace
}  // namespace navvy::vehicle
