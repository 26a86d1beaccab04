// SPDX-License-Identifier: Apache-2.0
// An engine with gears by itself, compared with the closed forms of geared_engine.h.
#include "vehicle/drive/geared_engine.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/saved_state.h"

namespace navvy::vehicle {
namespace {

constexpr double kStep = 1.0 / 600;

/// Returns an engine with 400 N m at idle, 100 rad/s; 500 at 200; 350 at the governed 300.
scene::CombustionEngine diesel() {
  scene::CombustionEngine engine;
  engine.curve = {{100, 400}, {200, 500}, {300, 350}};
  engine.braking_torque = 60;
  engine.gears = {4, 2, 1};
  engine.final_ratio = 10;
  engine.efficiency = 0.9;
  return engine;
}

int gear_of(const GearedEngine& engine) { return engine.state(0, 0, 0).gear; }

/// Returns an engine in a commanded gear.
GearedEngine in_gear(int gear, bool drives_pump = false) {
  GearedEngine engine(diesel(), drives_pump);
  engine.shift(gear, 0, 0, kStep);
  return engine;
}

TEST(GearedEngine, IsStrongestWithinALineOfItsCurve) {
  // T = 800 - 1.5 w: T w is largest at 800 / 3.
  const scene::CombustionEngine::Point rated = scene::rated_point(diesel());
  EXPECT_NEAR(rated.speed, 800.0 / 3, 1e-9);
  EXPECT_NEAR(rated.torque, 400, 1e-9);
}

TEST(GearedEngine, TurnsTheDifferentialCarrierAtTheGovernedSpeed) {
  const GearedEngine engine = in_gear(1);
  EXPECT_DOUBLE_EQ(engine.fastest(1), 300.0 / 40);
  EXPECT_DOUBLE_EQ(engine.fastest(2), 300.0 / 20);
  EXPECT_DOUBLE_EQ(engine.fastest(3), 30);
  EXPECT_DOUBLE_EQ(engine.fastest(0), 30) << "the last one is available";
}

TEST(GearedEngine, TransmitsItsCurveTimesRatioTimesEfficiency) {
  const GearedEngine engine = in_gear(1);
  EXPECT_NEAR(engine.bounds(5, 0).high, 40 * 0.9 * 500, 1e-9);
  EXPECT_NEAR(engine.bounds(3.75, 0).high, 40 * 0.9 * 450, 1e-9) << "halfway between two points";
  EXPECT_NEAR(engine.bounds(7.6, 0).high, 40 * 0.9 * 350 * 2 / 3, 1e-9)
      << "a third of the governor's droop";
  EXPECT_EQ(engine.bounds(7.9, 0).high, 0) << "nothing above it";
  EXPECT_NEAR(in_gear(3).bounds(20, 0).high, 10 * 0.9 * 500, 1e-9);
}

TEST(GearedEngine, IsNeverSlowerThanAtIdle) {
  const GearedEngine engine = in_gear(2);
  for (const double carrier : {-3.0, 0.0, 2.0}) {
    EXPECT_NEAR(engine.bounds(carrier, 0).high, 20 * 0.9 * 400, 1e-9) << carrier;
    EXPECT_EQ(engine.bounds(carrier, 0).low, 0) << carrier;
    EXPECT_EQ(engine.state(carrier, 1000, 0).speed, 100) << carrier;
  }
}

TEST(GearedEngine, BrakesByItsDragAndItsLosses) {
  const GearedEngine engine = in_gear(1);
  EXPECT_NEAR(engine.bounds(5, 0).low, -40 / 0.9 * 60, 1e-9);
  EXPECT_NEAR(engine.bounds(8, 0).low, -40 / 0.9 * 60, 1e-9) << "above the governed speed, too";
  // Half of it at 1.125 times idle.
  EXPECT_NEAR(engine.bounds(112.5 / 40, 0).low, -40 / 0.9 * 30, 1e-9);
  EXPECT_NEAR(engine.state(5, -40 / 0.9 * 60, 0).torque, -60, 1e-9);
}

TEST(GearedEngine, SuppliesThePumpFirst) {
  const GearedEngine engine = in_gear(1, true);
  const double rated = 800.0 / 3 * 400;
  // It runs at its largest power while the clutch slips.
  const double high = engine.bounds(0, 50e3).high;
  EXPECT_NEAR(high, 40 * 0.9 * (400 - 50e3 / (800.0 / 3)), 1e-6);
  const CombustionEngineState state = engine.state(0, high, 50e3);
  EXPECT_NEAR(state.speed, 800.0 / 3, 1e-9);
  EXPECT_NEAR(state.power, rated, 1e-6);
  EXPECT_EQ(engine.bounds(0, 1.1 * rated).high, 0);
  for (double carrier = 0; carrier < 7.5; carrier += 0.1)
    EXPECT_LE(engine.state(carrier, engine.bounds(carrier, 30e3).high, 30e3).power,
              rated * (1 + 1e-12))
        << carrier;
}

TEST(GearedEngine, ChoosesTheHighestGearThatPullsAndDoesNotHunt) {
  GearedEngine engine(diesel(), false);
  engine.shift(0, 0, 1000, kStep);
  EXPECT_EQ(gear_of(engine), 1) << "the others would slip";
  // The second one has 20 x 0.9 x 420 = 7560 N m at 6 rad/s, the third would be below idle.
  engine.shift(0, 6, 7000, kStep);
  EXPECT_EQ(gear_of(engine), 1) << "a quarter in reserve";
  engine.shift(0, 6, 5000, kStep);
  EXPECT_EQ(gear_of(engine), 2);
  for (int i = 0; i < 599; ++i) engine.shift(0, 6, 9000, kStep);
  EXPECT_EQ(gear_of(engine), 2) << "not within a second";
  for (int i = 0; i < 2; ++i) engine.shift(0, 6, 9000, kStep);
  EXPECT_EQ(gear_of(engine), 1);
  engine.shift(0, 8, 9000, kStep);
  EXPECT_EQ(gear_of(engine), 2) << "at once, before it overspeeds";
  engine.shift(0, 4, 100, kStep);
  EXPECT_EQ(gear_of(engine), 1) << "at once, before it slips";
}

TEST(GearedEngine, AtItsGovernedSpeedChangesUpIfTheNextGearKeepsIt) {
  GearedEngine engine(diesel(), false);
  // The demand exceeds every gear. On a climb the first gives 8400 N m at 304 rad/s and the second
  // 8136.
  engine.shift(0, 7.6, 3e4, kStep);
  EXPECT_EQ(gear_of(engine), 1);
  // On the level the engine reaches 310 rad/s, where it gives 2100.
  engine.shift(0, 7.75, 3e4, kStep);
  EXPECT_EQ(gear_of(engine), 2);
  // Then it accelerates; otherwise the first gear returns after a second.
  for (int i = 0; i < 700; ++i) engine.shift(0, 7.75, 3e4, kStep);
  EXPECT_EQ(gear_of(engine), 2) << "the first would overspeed";
  engine.shift(0, 7.4, 3e4, kStep);
  EXPECT_EQ(gear_of(engine), 1);
}

TEST(GearedEngine, ChoosesAGearThatBrakes) {
  GearedEngine engine(diesel(), false);
  engine.shift(3, 20, 0, kStep);
  // At 14 rad/s the second holds 20 / 0.9 x 60 = 1333 N m, the third 667.
  for (int i = 0; i < 700; ++i) engine.shift(0, 14, -1000, kStep);
  EXPECT_EQ(gear_of(engine), 2);
  EXPECT_NEAR(engine.bounds(14, 0).low, -20 / 0.9 * 60, 1e-9);
}

TEST(GearedEngine, UsesTheCommandedGear) {
  GearedEngine engine(diesel(), false);
  for (const int gear : {3, 1, 2}) {
    engine.shift(gear, 20, 1e5, kStep);
    EXPECT_EQ(gear_of(engine), gear);
  }
  engine.shift(9, 0, 0, kStep);
  EXPECT_EQ(gear_of(engine), 3);
}

TEST(GearedEngine, HasOnlyLimitsAsASpeedSource) {
  scene::CombustionEngine motor;
  motor.kind = scene::CombustionEngine::Kind::kSpeedSource;
  motor.max_speed = 200, motor.max_torque = 5;
  motor.gears = {20};
  motor.efficiency = 0.8;
  GearedEngine engine(motor, false);
  engine.shift(0, 0, 100, kStep);
  EXPECT_EQ(engine.fastest(0), 10);
  EXPECT_NEAR(engine.bounds(3, 0).high, 20 * 0.8 * 5, 1e-12);
  EXPECT_NEAR(engine.state(3, 20 * 0.8 * 5, 0).torque, 5, 1e-12);
  EXPECT_EQ(engine.state(3, 0, 0).speed, 60);
}

TEST(GearedEngine, IsTheSameAfterASnapshot) {
  GearedEngine engine(diesel(), false), copy(diesel(), false);
  engine.shift(0, 6, 100, kStep);
  load_saved(saved(engine), copy);
  EXPECT_EQ(gear_of(copy), gear_of(engine));
  for (int i = 0; i < 700; ++i) {
    engine.shift(0, 6, 9000, kStep), copy.shift(0, 6, 9000, kStep);
    ASSERT_EQ(gear_of(copy), gear_of(engine)) << i;
  }
}

TEST(GearedEngine, WithoutGearsOrACurveIsRefused) {
  scene::CombustionEngine engine = diesel();
  engine.gears.clear();
  EXPECT_THROW(GearedEngine(engine, false), InputError);
  engine = diesel();
  engine.curve.resize(1);
  EXPECT_THROW(GearedEngine(engine, false), InputError);
}

}  // namespace
}  // namespace navvy::vehicle
