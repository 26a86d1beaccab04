// SPDX-License-Identifier: Apache-2.0
// Rigid contacts of bodies with the ground and with each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::box;
using testing::flat;
using testing::FunctionGround;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

TEST(BulletContact, BoxRestsOnTheGroundWithItsWeight) {
  // High up and with an asymmetric relief elsewhere: the ground is neither shifted nor mirrored.
  const FunctionGround ground(
      [](double x, double y) { return 1000 + (x > 2 && y < -1 ? 1.0 : 0.0); });
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0.3, 0.4, 1000.8));
  engine->add_machine(box(), make_pose(3, -2.5, 1001.8));
  run(*engine, ground, 2, kStep);
  Vec3 impulse = Vec3::Zero();
  run(*engine, ground, 2, kStep, [&](double) { impulse += engine->accounts()->ground_impulse(0); });
  // 1 cm: the contact is a stiff spring (1000 kg on 4 x 2e7 N/m is 0.1 mm) plus Bullet's margins.
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 1000.5, 0.01);
  EXPECT_NEAR(engine->link(1, 0).X_WL.translation().z(), 1001.5, 0.01);
  // Contacts are detected anew in every step, so a resting box vibrates by less than a centimetre
  // per second.
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 0.02);
  EXPECT_NEAR(impulse.z(), 1000 * kGravity * 2, 0.005 * 1000 * kGravity * 2);
}

TEST(BulletContact, FrictionHoldsBelowAndSlidesAboveItsAngle) {
  for (const double angle : {20.0, 35.0}) {  // the box has mu 0.5, 26.6 degrees
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(
        box(), make_pose(2, 0, 2 * std::tan(radians(angle)) + 0.5 / std::cos(radians(angle)) + 0.01,
                         0, -radians(angle)));
    const auto ground = testing::slope(radians(angle));
    run(*engine, ground, 1, kStep);
    const double v = engine->link(0, 0).v_WL.norm();
    if (angle < 26) {
      EXPECT_LT(v, 0.02);
      // Normal and friction together carry the weight.
      Vec3 impulse = Vec3::Zero();
      run(*engine, ground, 1, kStep,
          [&](double) { impulse += engine->accounts()->ground_impulse(0); });
      EXPECT_LT((impulse + 1000 * kDown).norm(), 0.01 * 1000 * kGravity);
    } else {
      const double expected =
          kGravity * (std::sin(radians(angle)) - 0.5 * std::cos(radians(angle)));
      EXPECT_NEAR(v, expected, 0.1 * expected);  // 10 %: the fall of the first centimetre
    }
  }
}

TEST(BulletContact, ABoxSlidesOverTrianglesLikeOverAPlane) {
  // It starts off the lattice's lines and slides down along, across and between them.
  const double angle = radians(35);
  const auto after_a_second = [&](double spacing, double yaw) {
    const Vec2 up(std::cos(yaw), std::sin(yaw));
    const FunctionGround ground(
        [&](double x, double y) { return std::tan(angle) * up.dot(Vec2(x, y)); }, spacing);
    const Vec2 start = 2 * up + Vec2(0.03, 0.02);
    auto engine = make_bullet_engine(kDown);
    const double z = ground.height(start.x(), start.y()) + 0.5 / std::cos(angle) + 0.002;
    engine->add_machine(box(), make_pose(start.x(), start.y(), z, 0, -angle, yaw));
    run(*engine, ground, 1, kStep);
    return engine->link(0, 0).v_WL;
  };
  const double expected = kGravity * (std::sin(angle) - 0.5 * std::cos(angle));
  for (const double yaw : {0.0, radians(20.0), radians(45.0)}) {
    // Two triangles as large as the slope have no inner edges to catch on.
    const Vec3 plane = after_a_second(40, yaw);
    // 15 %: across its two directions Bullet's friction is too small by that much; along them it is
    // right to 1 %.
    EXPECT_NEAR(plane.norm(), expected, (yaw > 0 ? 0.15 : 0.01) * expected)
        << degrees(yaw) << " deg";
    for (const double spacing : {0.05, 0.1, 0.2})
      EXPECT_LT((after_a_second(spacing, yaw) - plane).norm(), 0.1 * expected)
          << spacing << " m, " << degrees(yaw) << " deg";
  }
}

TEST(BulletContact, ABodyOnAnEdgeOfTheGroundRestsOnItsTop) {
  // A terrace 1 m high with a wall one cell wide: a box that overhangs it by a third is held, not
  // pushed off.
  const FunctionGround ground([](double x, double) { return x < 0.01 ? 1.0 : 0.0; }, 0.1);
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(-0.17, 0.03, 1.5));
  run(*engine, ground, 2, kStep);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 1.5, 0.02);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().x(), -0.17, 0.02);
}

TEST(BulletContact, AWallOfTheGroundStopsABody) {
  const FunctionGround ground([](double x, double) { return x > 0.99 ? 1.0 : 0.0; }, 0.1);
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0, 0.03, 0.5));
  engine->apply_impulse(0, 0, Vec3(3000, 0, 0), Vec3::Zero(), Vec3(0, 0.03, 0.5));
  double highest = 0;
  run(*engine, ground, 2, kStep,
      [&](double) { highest = std::max(highest, engine->link(0, 0).X_WL.translation().z()); });
  // The wall begins at 0.9 m, half a metre before the box's middle.
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().x(), 0.4, 0.05);
  EXPECT_LT(highest, 0.6);
}

TEST(BulletContact, RaisedGroundDoesNotLaunchABody) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0, 0, 0.5));
  run(*engine, flat(), 1, kStep);
  const FunctionGround raised([](double, double) { return 0.3; });
  double fastest = 0;
  run(*engine, raised, 3, kStep,
      [&](double) { fastest = std::max(fastest, engine->link(0, 0).v_WL.z()); });
  EXPECT_LT(fastest, 1.0);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 0.8, 0.02);
}

TEST(BulletContact, LoweredGroundLetsABodyFall) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0, 0, 0.5));
  run(*engine, flat(), 1, kStep);
  run(*engine, FunctionGround([](double, double) { return -2.0; }), 0.2, kStep);
  // No stale contact holds it: free fall, first order in the step.
  EXPECT_NEAR(engine->link(0, 0).v_WL.z(), -kGravity * 0.2, 0.02 * kGravity * 0.2);
}

TEST(BulletContact, MachinesPushEachOtherAndMomentumIsConserved) {
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(box(), Pose::Identity());
  engine->add_machine(box(), make_pose(1.5, 0.1, 0.05));
  engine->apply_impulse(0, 0, Vec3(2000, 0, 0), Vec3::Zero(), Vec3::Zero());
  run(*engine, FunctionGround([](double, double) { return -5.0; }), 1, kStep);
  EXPECT_GT(engine->accounts()->momentum(1).x(), 500);
  // 1e-6: the iterations of the solver act equally on both bodies.
  EXPECT_LT(
      (engine->accounts()->momentum(0) + engine->accounts()->momentum(1) - Vec3(2000, 0, 0)).norm(),
      2e-3);
  EXPECT_TRUE(engine->accounts()->ground_impulse(1).isZero());
}

TEST(BulletContact, EachBodyTouchesTheFullGroundFarFromOthers) {
  // A ridge one cell wide under one of two boxes a kilometre apart must be sampled.
  const FunctionGround ground(
      [](double x, double) { return std::abs(x - 1000) < 0.05 ? 0.2 : 0.0; });
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(box(), make_pose(0, 0, 0.5));
  engine->add_machine(box(), make_pose(1000, 0, 0.72));
  run(*engine, ground, 0.3, kStep);
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().z(), 0.5, 0.01);
  EXPECT_NEAR(engine->link(1, 0).X_WL.translation().z(), 0.7, 0.02);
}

TEST(BulletContact, NamesABodyThatFallsThroughTheGround) {
  auto engine = make_bullet_engine(kDown);
  scene::Machine ghost = box();
  ghost.name = "ghost";
  ghost.links[0].collisions.clear();
  engine->add_machine(ghost, make_pose(3, 4, 0.5));
  try {
    run(*engine, flat(), 5, kStep);
    FAIL() << "it falls for ever";
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("'ghost' has fallen through the ground at x 3"),
              std::string::npos)
        << error.what();
  }
}

TEST(BulletContact, FindsTwoTouchingBodiesOfTwoHundredWithoutTestingAllPairs) {
  // Contacts do not depend on other bodies: the pair in the crowd moves exactly like the pair
  // alone.
  const auto end = [&](int others) {
    auto engine = make_bullet_engine(Vec3::Zero());
    engine->add_machine(box(), make_pose(0, 0, 50));
    engine->add_machine(box(), make_pose(1.5, 0.1, 50.05));
    for (int i = 0; i < others; ++i) {
      const int column = i % 15, row = i / 15;
      engine->add_machine(box(), make_pose(-3.0 * column - 5, 3.0 * row, 50));
    }
    engine->apply_impulse(0, 0, Vec3(2000, 0, 0), Vec3::Zero(), Vec3(0, 0, 50));
    run(*engine, flat(), 0.5, kStep);
    return std::array<Vec3, 2>{engine->link(0, 0).X_WL.translation(),
                               engine->link(1, 0).X_WL.translation()};
  };
  EXPECT_EQ(end(0), end(200));
}

TEST(BulletContact, ExcavatorsStandAndDriveInOneWorldWithoutTouching) {
  const scene::Machine m = testing::ew180();
  const auto together = [&](bool second) {
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(m, Pose::Identity());
    if (second) engine->add_machine(m, make_pose(0, 8, 0, 0, 0, 1));
    engine->set_drive(0, {1, 0.2, false});
    if (second) engine->set_drive(1, {-1, 0.1, false});
    run(*engine, flat(), 2, kStep);
    return engine->link(0, 0).X_WL.translation();
  };
  // 1e-4: the solver stops at the residual of both, so the last digits differ.
  EXPECT_LT((together(true) - together(false)).norm(), 1e-4);
}

}  // namespace
}  // namespace navvy::vehicle
