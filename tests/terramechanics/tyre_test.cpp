// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/tyre.h"

#include <gtest/gtest.h>

#include <cmath>

#include "terramechanics/grounds.h"

namespace navvy::terramechanics {
namespace {

constexpr double kStep = 1.0 / 600;

scene::Wheel twin() {
  scene::Wheel wheel;
  wheel.twin_spacing = 0.32;
  wheel.damping = 0;
  return wheel;
}

TyreMotion at(double height, double x = 0) {
  TyreMotion motion;
  motion.X_WWheel.translation() = Vec3(x, 0, height);
  motion.spin_inertia = 60;
  return motion;
}

TEST(TyreForce, CarriesByItsDeflectionOnAnyPlane) {
  const scene::Wheel tyre = twin();
  // The exact deflection of a disc on a plane, independent of the rays.
  for (const double angle : {0.0, 3.0, 7.5, 11.0, 20.0}) {
    const FunctionGround ground = slope(radians(angle));
    const double away = tyre.radius - 0.03;  // distance of the centre from the plane
    TyreState state;
    const TyreForce out =
        tyre_force(tyre, at(away / std::cos(radians(angle))), ground, kStep, state);
    const Vec3 normal(-std::sin(radians(angle)), 0, std::cos(radians(angle)));
    EXPECT_NEAR(out.deflection, 0.03, 1e-9) << angle;
    EXPECT_TRUE(out.force_W.isApprox(tyre.stiffness * 0.03 * normal, 1e-6)) << angle;
  }
}

TEST(TyreForce, IsZeroInTheAir) {
  TyreState state;
  state.bristle[0] = Vec2(0.01, 0);
  const TyreForce out = tyre_force(twin(), at(0.6), flat(), kStep, state);
  EXPECT_TRUE(out.force_W.isZero());
  EXPECT_TRUE(state.bristle[0].isZero());  // a strip without contact forgets its state
}

TEST(TyreForce, FrictionIsLimitedByCoulomb) {
  TyreMotion motion = at(0.49);
  motion.v_W = Vec3(3, 4, 0);  // locked wheel dragged askew
  TyreState state;
  TyreForce out;
  scene::Wheel tyre = twin();
  tyre.friction = 0.6;
  for (int i = 0; i < 100; ++i) out = tyre_force(tyre, motion, flat(), kStep, state);
  const double normal = out.force_W.z();
  EXPECT_NEAR(out.force_W.head<2>().norm(), 0.6 * normal, 1e-6 * normal);
  EXPECT_NEAR(out.force_W.y() / out.force_W.x(), 4.0 / 3.0, 1e-6);
  EXPECT_LT(out.force_W.x(), 0);
  EXPECT_NEAR(out.slip, -1, 1e-12);
}

TEST(TyreForce, StretchedBristleHoldsWithoutCreep) {
  TyreState state;
  state.bristle = {Vec2(0.005, 0), Vec2(0.005, 0)};
  const TyreForce first = tyre_force(twin(), at(0.49), flat(), kStep, state);
  TyreForce last;
  for (int i = 0; i < 10000; ++i) last = tyre_force(twin(), at(0.49), flat(), kStep, state);
  EXPECT_LT(first.force_W.x(), -1000);
  EXPECT_EQ(first.force_W.x(), last.force_W.x());
}

TEST(TyreForce, RollingWheelSlipsInProportionToItsForce) {
  // Steady slip kappa gives F = k sigma kappa: bristles of stiffness k renewed over the relaxation
  // length sigma.
  const scene::Wheel tyre = twin();
  TyreMotion motion = at(0.49);
  motion.v_W = Vec3(2, 0, 0);
  motion.spin = 2.02 / 0.49;
  TyreState state;
  TyreForce out;
  for (int i = 0; i < 2000; ++i) out = tyre_force(tyre, motion, flat(), kStep, state);
  const double expected = 0.8 * tyre.stiffness * 0.6 * tyre.radius * 0.02 / 2.02;
  EXPECT_NEAR(out.slip, 0.02 / 2.02, 1e-9);
  // 1 %: the implicit step of the bristle.
  EXPECT_NEAR(out.force_W.x(), expected, 0.01 * expected);
  EXPECT_GT(out.force_W.x(), 0);  // a wheel that turns faster pushes forward
}

TEST(TyreForce, TwinOnAnEdgeIsCarriedByOneTyre) {
  const FunctionGround ground([](double, double y) { return y > 0 ? 0.0 : -1.0; });
  TyreState state;
  const TyreForce out = tyre_force(twin(), at(0.49), ground, kStep, state);
  EXPECT_NEAR(out.force_W.z(), 0.5 * 1.2e6 * 0.035, 1);
  EXPECT_GT(out.moment_W.x(), 0);  // lifts the left side
}

TEST(TyreFriction, IsTheWeakerOfRubberAndSoil) {
  scene::Wheel tyre;
  tyre.friction = 0.7;
  scene::Soil clay;
  clay.friction_angle = radians(20);
  clay.cohesion = 20e3, clay.residual_cohesion = 6e3, clay.loose_cohesion = 5e3, clay.swell = 1.2;
  EXPECT_EQ(tyre_friction(tyre, {}, 1e5), 0.7);
  EXPECT_NEAR(tyre_friction(tyre, {&clay, 1}, 1e5), std::tan(radians(20)) + 0.2, 1e-12);
  EXPECT_NEAR(tyre_friction(tyre, {&clay, 1.1}, 1e5), std::tan(radians(20)) + 0.125, 1e-12);
  EXPECT_NEAR(tyre_friction(tyre, {&clay, 1.2}, 1e5), std::tan(radians(20)) + 0.05, 1e-12);
  EXPECT_NEAR(tyre_friction(tyre, {&clay, 0.9}, 1e5), std::tan(radians(20)) + 0.2, 1e-12);
  // Cohesion holds a light wheel better than its rubber
  EXPECT_EQ(tyre_friction(tyre, {&clay, 1}, 2e4), 0.7);
}

TEST(TyreForce, QueriesTheSoilUnderEachTouchingStrip) {
  const scene::Soil loam;
  std::vector<Vec2> asked;
  FunctionGround ground([](double, double y) { return y > 0 ? 0.0 : -1.0; });
  ground.set_soil([&](double x, double y) {
    asked.emplace_back(x, y);
    return SoilState{&loam, 1.1};
  });
  TyreState state;
  tyre_force(twin(), at(0.49, 3), ground, kStep, state);
  ASSERT_EQ(asked.size(), 1u);  // the other tyre hangs over the edge
  EXPECT_NEAR(asked[0].x(), 3, 1e-9);
  EXPECT_NEAR(asked[0].y(), 0.16, 1e-9);
  EXPECT_NEAR(ground.at(3, 0.16).soil.density(), loam.bank_density / 1.1, 1e-9);
  EXPECT_EQ(flat().at(3, 0.16).soil.density(), 0);  // a firm floor
}

}  // namespace
}  // namespace navvy::terramechanics
