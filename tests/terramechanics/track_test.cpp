// SPDX-License-Identifier: Apache-2.0
// The law of a single track: thrust against slip, standing still, resistance.
#include "terramechanics/track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "terramechanics/bearing.h"
#include "terramechanics/grounds.h"
#include "terramechanics/plate.h"
#include "values.h"

namespace navvy::terramechanics {
namespace {

constexpr double kStep = 1.0 / 1000;

/// Eight rollers every 0.35 m at z = 0.15, so that the lower run is at z = 0.
scene::Wheel running_track() {
  scene::Track track;
  for (int i = 0; i < 8; ++i) track.rollers.emplace_back(1.225 - 0.35 * i, 0, 0.15);
  track.p_idler = Vec3(1.7, 0, 0.5);
  track.idler_radius = 0.35;
  scene::Wheel wheel;
  wheel.radius = 0.35;
  wheel.width = 0.5;
  wheel.stiffness = 1e7;
  wheel.damping = 1e5;
  wheel.friction = 0.7;
  wheel.rolling_resistance = 0;
  wheel.track = track;
  return wheel;
}

/// Pressed by 5 mm, 50 kN, at these speeds over the ground and of the track [m/s].
TrackMotion moving(double ground_speed, double track_speed) {
  TrackMotion motion;
  motion.X_WC = make_pose(0, 0, -0.005);
  motion.v_W = Vec3(ground_speed, 0, 0);
  motion.p_sprocket = Vec3(-1.7, 0, 0.5);
  motion.spin = track_speed / 0.35;
  motion.spin_inertia = 150;
  return motion;
}

/// After the track has moved by twice its length.
TrackForce steady(const scene::Wheel& wheel, const TrackMotion& motion, const GroundQuery& ground) {
  TrackState state = TrackState::of(*wheel.track);
  TrackForce force;
  for (int i = 0; i < 8000; ++i) force = track_force(wheel, motion, ground, kStep, state);
  return force;
}

scene::Soil clay() {
  scene::Soil soil;
  soil.cohesion = 12e3;
  soil.residual_cohesion = 3e3;
  soil.friction_angle = radians(18);
  soil.janosi_k = 0.03;
  soil.swell = 1.2;
  return soil;
}

TEST(Track, ThrustGrowsWithSlipByJanosiAndHanamoto) {
  const scene::Wheel wheel = running_track();
  const scene::Soil soil = clay();
  FunctionGround ground = flat();
  ground.set_soil([&soil](double, double) { return SoilState{&soil, 1.0}; });
  const double length = 8 * 0.35, area = length * wheel.width;
  for (const double slip : {0.02, 0.05, 0.1, 0.2, 0.5}) {
    const TrackForce force = steady(wheel, moving(1 - slip, 1), ground);
    const double load = force.force_W.z();
    EXPECT_NEAR(load, 50e3, 1);
    // F = (A c + W tan phi) (1 - K / (i L) (1 - exp(-i L / K))) under even pressure [Wong 2008].
    const double x = slip * length / soil.janosi_k;
    const double expected = (area * soil.cohesion + load * std::tan(soil.friction_angle)) *
                            (1 - (1 - std::exp(-x)) / x);
    print_value("thrust at slip " + std::to_string(slip) + " [N]", force.force_W.x(),
                std::to_string(expected) + " +-4 %", "[Wong 2008]");
    // 4 %: eight segments, on each of which shear is evaluated at its middle.
    EXPECT_NEAR(force.force_W.x(), expected, 0.04 * expected);
    EXPECT_NEAR(force.slip, slip, 1e-9);
    // The sprocket provides the thrust of the machine.
    EXPECT_NEAR(force.torque, -wheel.radius * force.force_W.x(), 1e-6 * std::abs(force.torque));
  }
}

TEST(Track, BrakesAndReversesLikeItDrives) {
  const scene::Wheel wheel = running_track();
  const double drives = steady(wheel, moving(0.9, 1), flat()).force_W.x();
  EXPECT_GT(drives, 0);
  EXPECT_NEAR(steady(wheel, moving(-0.9, -1), flat()).force_W.x(), -drives, 1e-6 * drives);
  EXPECT_LT(steady(wheel, moving(1, 0.9), flat()).force_W.x(), 0);
}

TEST(Track, GripsAFloorByCoulombAndNoMore) {
  const scene::Wheel wheel = running_track();
  EXPECT_NEAR(steady(wheel, moving(0, 1), flat()).force_W.x(), 0.7 * 50e3, 0.01 * 0.7 * 50e3);
  // The bound also applies to the sum with a lateral force.
  TrackMotion aside = moving(0, 1);
  aside.v_W.y() = 1;
  const TrackForce force = steady(wheel, aside, flat());
  EXPECT_NEAR(force.force_W.head<2>().norm(), 0.7 * 50e3, 0.02 * 0.7 * 50e3);
  EXPECT_NEAR(force.force_W.x(), -force.force_W.y(), 0.02 * 0.7 * 50e3);
}

TEST(Track, HasTheLooseCohesionOnLooseSoil) {
  const scene::Wheel wheel = running_track();
  scene::Soil soil = clay();
  soil.loose_cohesion = 1e3;
  EXPECT_DOUBLE_EQ(track_strength(wheel, {&soil, 1.0}).cohesion, 12e3);
  EXPECT_DOUBLE_EQ(track_strength(wheel, {&soil, 0.95}).cohesion, 12e3);
  EXPECT_NEAR(track_strength(wheel, {&soil, 1.1}).cohesion, 6.5e3, 1e-6);
  EXPECT_DOUBLE_EQ(track_strength(wheel, {&soil, 1.2}).cohesion, 1e3);
  // At most the residual cohesion, as in the law.
  soil.loose_cohesion = 5e3;
  EXPECT_DOUBLE_EQ(track_strength(wheel, {&soil, 1.2}).cohesion, 3e3);
  EXPECT_DOUBLE_EQ(track_strength(wheel, {}).slope, 0.7);
}

TEST(Track, HasBekkersResistanceOnUntouchedGround) {
  // It is in its own rut as deep as its pressure makes it; the ground ahead is untouched.
  scene::Wheel wheel = running_track();
  const scene::Soil soil = clay();
  const double pressure = 50e3 / (8 * 0.35 * 0.5), z = plate_sinkage(soil, pressure, wheel.width);
  FunctionGround ground([z](double x, double) { return x > 1.45 ? 0.0 : -z; }, 0.1);
  ground.set_soil([&soil](double, double) { return SoilState{&soil, 1.0}; });
  TrackMotion motion = moving(1, 1);
  motion.X_WC.translation().z() -= z;
  const double compaction = wheel.width * pressure * z / (soil.bekker_n + 1);
  // Its idler rolls over z without slip and pushes as much soil ahead as a wheel does.
  const double idler = wheel.track->idler_radius + wheel.track->thickness;
  const double expected = compaction + bulldozing({&soil, 1}, wheel.width, idler, z, 1);
  EXPECT_GT(expected, 1.01 * compaction);
  EXPECT_NEAR(steady(wheel, motion, ground).force_W.x(), -expected, 0.02 * expected);
  // In an existing rut there is none.
  FunctionGround rut([z](double, double) { return -z; });
  rut.set_soil([&soil](double, double) { return SoilState{&soil, 1.0}; });
  EXPECT_NEAR(steady(wheel, motion, rut).force_W.x(), 0, 0.01 * expected);
}

TEST(Track, CarriesNothingInTheAirAndForgets) {
  const scene::Wheel wheel = running_track();
  TrackState state = TrackState::of(*wheel.track);
  for (int i = 0; i < 100; ++i) track_force(wheel, moving(0, 1), flat(), kStep, state);
  EXPECT_GT(state.contacts[4].shear.norm(), 0);
  TrackMotion high = moving(0, 1);
  high.X_WC.translation().z() = 1;
  const TrackForce force = track_force(wheel, high, flat(), kStep, state);
  EXPECT_TRUE(force.pushes.empty());
  EXPECT_EQ(force.force_W.norm(), 0);
  EXPECT_EQ(state.contacts[4].shear.norm(), 0);
  EXPECT_TRUE(track_patches(wheel, high, state).empty());
}

TEST(Track, ClimbsWithItsIdler) {
  // A step of 0.2 m before the idler pushes it back and up.
  const scene::Wheel wheel = running_track();
  const FunctionGround step([](double x, double) { return x > 1.95 ? 0.3 : 0.0; });
  const TrackForce force = steady(wheel, moving(0, 0), step);
  EXPECT_LT(force.force_W.x(), 0);
  EXPECT_GT(force.force_W.z(), 50e3);
}

}  // namespace
}  // namespace navvy::terramechanics
