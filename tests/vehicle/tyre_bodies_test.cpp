// SPDX-License-Identifier: Apache-2.0
// Wheels in contact with bodies: pipes, kerbs, walls, plates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/saved_state.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::cart;
using testing::ew180;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

/// A body of one link that collides as `geometry`.
scene::Machine body(const scene::Geometry& geometry, double mass, bool stands) {
  scene::Machine m;
  m.name = "body";
  m.fixed_base = stands;
  m.links.push_back(testing::box_link("body", Pose::Identity(), mass, Vec3::Zero(), Vec3(1, 1, 1)));
  scene::Collision collision;
  collision.name = "shape";
  collision.geometry = geometry;
  m.links[0].collisions.push_back(collision);
  return m;
}

scene::Machine block(const Vec3& size, bool stands = true, double mass = 1000) {
  scene::Geometry geometry;
  geometry.size = size;
  return body(geometry, mass, stands);
}

/// Returns a pipe along its own z.
scene::Machine pipe(double radius, double length, bool stands) {
  scene::Geometry geometry;
  geometry.kind = scene::Geometry::Kind::kCylinder;
  geometry.radius = radius;
  geometry.length = length;
  return body(geometry, 500, stands);
}

double wheel_height(const PhysicsEngine& engine, int machine, int wheel) {
  return engine.wheel(machine, wheel).X_WWheel.translation().z();
}

TEST(TyreBodies, APipeLiftsTheAxleByItsHeight) {
  // The excavator is lowered with its front axle on a pipe of 0.4 m, with brakes held.
  const auto axle = [](bool on_pipe) {
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(
        ew180(), make_pose(0, 0, on_pipe ? 0.05 : 0, 0, on_pipe ? -std::atan(0.4 / 2.8) : 0));
    if (on_pipe) engine->add_machine(pipe(0.2, 4, true), make_pose(2.77, 0, 0.2, kPi / 2));
    engine->set_drive(0, {0, 0, true});
    run(*engine, flat(), 4, kStep);
    return 0.5 * (wheel_height(*engine, 0, 0) + wheel_height(*engine, 0, 1));
  };
  // 20 mm: half of the tyres' deflection; a round top deflects them no more than ground, as the law
  // uses depth and no area, and a raised front shifts load to the rear.
  EXPECT_NEAR(axle(true) - axle(false), 0.4, 0.02);
}

TEST(TyreBodies, DrivesOverAPipeWithoutBeingLaunched) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(ew180(), Pose::Identity());
  engine->add_machine(pipe(0.06, 4, true), make_pose(4.5, 0, 0.06, kPi / 2));
  engine->set_drive(0, {0.8, 0, false});
  double front = 0, rear = 0, fastest = 0;
  run(*engine, flat(), 7, kStep, [&](double) {
    front = std::max(front, wheel_height(*engine, 0, 0));
    rear = std::max(rear, wheel_height(*engine, 0, 2));
    for (int w = 0; w < 4; ++w) fastest = std::max(fastest, std::abs(engine->wheel(0, w).v_W.z()));
  });
  EXPECT_NEAR(front, 0.12 + 0.525, 0.06);  // a tyre deflects by some centimetres
  EXPECT_NEAR(rear, 0.12 + 0.525, 0.06);
  EXPECT_LT(fastest, 1.0);
  EXPECT_GT(engine->link(0, 0).X_WL.translation().x(), 4.6);
}

TEST(TyreBodies, AWheelClimbsAKerb) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(ew180(), Pose::Identity());
  engine->add_machine(block(Vec3(8, 6, 0.15)), make_pose(8.5, 0, 0.075));
  run(*engine, flat(), 1, kStep);
  const double before = wheel_height(*engine, 0, 0);
  engine->set_drive(0, {0.8, 0, false});
  run(*engine, flat(), 6, kStep);
  EXPECT_GT(engine->wheel(0, 0).X_WWheel.translation().x(), 6.0);
  EXPECT_NEAR(wheel_height(*engine, 0, 0) - before, 0.15, 0.02);
}

TEST(TyreBodies, AWheelStopsAtAWall) {
  // The cart has no shape of its own: only its tyres touch the wall of 0.8 m.
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(cart(), Pose::Identity());
  engine->add_machine(block(Vec3(2, 6, 0.8)), make_pose(5.5, 0, 0.4));
  engine->set_drive(0, {0.8, 0, false});
  double farthest = 0, highest = 0;
  run(*engine, flat(), 6, kStep, [&](double) {
    farthest = std::max(farthest, engine->wheel(0, 0).X_WWheel.translation().x());
    highest = std::max(highest, wheel_height(*engine, 0, 0));
  });
  // A radius before the wall, minus the deflection of the tyre under impact and thrust; the tread
  // climbs a little.
  EXPECT_NEAR(farthest, 4.5 - 0.525, 0.1);
  EXPECT_LT(highest, 0.525 + 0.3);
}

TEST(TyreBodies, AWheelOnAPlateLoadsThePlateAndNotTheGround) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(cart(), make_pose(0, 0, 0.1));
  engine->add_machine(block(Vec3(8, 6, 0.1)), make_pose(1.4, 0, 0.05));
  run(*engine, flat(), 3, kStep);
  double load = 0;
  for (int w = 0; w < 4; ++w) {
    const WheelState wheel = engine->wheel(0, w);
    load += wheel.force_W.z();
    EXPECT_NEAR(wheel.body_W.z(), wheel.force_W.z(), 1e-9);
  }
  EXPECT_NEAR(load, 2000 * kGravity, 0.01 * 2000 * kGravity);
  EXPECT_TRUE(engine->accounts()->ground_impulse(0).isZero());
}

TEST(TyreBodies, TyreAndBodyConserveMomentum) {
  // Without weight and ground: a cart rolls against a free crate.
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(cart(), make_pose(0, 0, 50));
  engine->add_machine(block(Vec3(1, 3, 1), false, 600), make_pose(4.2, 0, 50.5));
  engine->apply_impulse(0, 0, Vec3(4000, 0, 0), Vec3::Zero(), Vec3(1.4, 0, 50.7));
  run(*engine, flat(), 1.5, kStep);
  EXPECT_GT(engine->accounts()->momentum(1).x(), 1000);
  EXPECT_LT(
      (engine->accounts()->momentum(0) + engine->accounts()->momentum(1) - Vec3(4000, 0, 0)).norm(),
      1e-3 * 4000);
}

TEST(TyreBodies, ALightBodyIsPushedAsideAndNotThrown) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(ew180(), Pose::Identity());
  engine->add_machine(block(Vec3(0.2, 0.2, 0.2), false, 5), make_pose(4, 0.97, 0.1));
  engine->set_drive(0, {0.8, 0, false});
  double fastest = 0;
  run(*engine, flat(), 4, kStep,
      [&](double) { fastest = std::max(fastest, engine->link(1, 0).v_WL.norm()); });
  // Expelled at most at a few times the machine's speed.
  EXPECT_LT(fastest, 8.0);
}

TEST(TyreBodies, AResumedRunOnAPlateIsBitIdentical) {
  const auto build = [] {
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(cart(), make_pose(0, 0, 0.1));
    engine->add_machine(block(Vec3(8, 6, 0.1)), make_pose(1.4, 0, 0.05));
    engine->set_drive(0, {0.5, 0.1, false});
    return engine;
  };
  auto whole = build();
  run(*whole, flat(), 1, kStep);
  const std::vector<char> bytes = saved(*whole);
  auto resumed = build();
  load_saved(bytes, *resumed);
  EXPECT_EQ(resumed->wheel(0, 0).force_W, whole->wheel(0, 0).force_W);
  run(*whole, flat(), 1, kStep);
  run(*resumed, flat(), 1, kStep);
  EXPECT_EQ(testing::digest(*whole), testing::digest(*resumed));
}

}  // namespace
}  // namespace navvy::vehicle
