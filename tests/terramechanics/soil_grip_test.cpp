// SPDX-License-Identifier: Apache-2.0
// Tyres on soil: strength of the soil mobilised by slip.
#include <gtest/gtest.h>

#include <cmath>

#include "terramechanics/bearing.h"
#include "terramechanics/grounds.h"
#include "terramechanics/shear.h"
#include "terramechanics/tyre.h"
#include "terramechanics/tyre_patch.h"
#include "terramechanics/tyre_strip.h"

namespace navvy::terramechanics {
namespace {

constexpr double kStep = 1.0 / 600;
// Height of the axle: 35 mm of deflection.
constexpr double kHeight = 0.49;

scene::Wheel twin() {
  scene::Wheel wheel;
  wheel.twin_spacing = 0.32;
  wheel.damping = 0;
  return wheel;
}

/// Returns level ground without ruts, so that only grip is measured.
FunctionGround level(const scene::Soil& soil) {
  FunctionGround ground = flat();
  ground.set_soil([&soil](double, double) { return SoilState{&soil, 1}; });
  return ground;
}

/// Returns the force after `seconds` at these speeds of carrier and rim [m/s].
TyreForce steady(const GroundQuery& ground, const Vec2& carrier, double rim, double seconds = 5) {
  TyreMotion motion;
  motion.X_WWheel.translation() = Vec3(0, 0, kHeight);
  motion.spin_inertia = 60;
  motion.v_W.head<2>() = carrier;
  motion.spin = rim / kHeight;
  TyreState state;
  TyreForce out;
  for (int i = 0; i < seconds / kStep; ++i) out = tyre_force(twin(), motion, ground, kStep, state);
  return out;
}

/// A rut that this tyre presses into level ground: it has sunk by `z` [m], and the ground from
/// `from` [m] on, in either direction, is untouched. The work of pressing is set so small that it
/// does not count.
class FreshRut final : public GroundQuery {
 public:
  FreshRut(const scene::Soil& soil, double z, double from = 0.47)
      : soil_(soil), z_(z), from_(from) {}
  double height(double x, double) const override { return std::abs(x) < from_ ? 0.0 : z_; }
  Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
  SoilState soil(double, double) const override { return {&soil_, 1}; }
  Sinkage sinking(double, double) const override { return {1e-9, z_}; }
  GroundLattice lattice() const override { return {Vec2::Zero(), 0.1}; }

 private:
  const scene::Soil& soil_;
  double z_, from_;
};

double limit_of(const scene::Soil& soil, double load) {
  const double pressure = tyre_patch(twin(), soil, load).pressure;
  return load * (std::tan(soil.friction_angle) + soil.cohesion / pressure);
}

TEST(TyreOnSoil, PullGrowsWithSlipAndSaturatesAtTheSoilsStrength) {
  const scene::Soil loam;
  const FunctionGround ground = level(loam);
  double before = 0, load = 0;
  for (const double slip : {0.02, 0.05, 0.1, 0.2, 0.4, 0.8}) {
    const TyreForce out = steady(ground, Vec2(1 - slip, 0), 1);
    load = out.force_W.z();
    EXPECT_GT(out.force_W.x(), before) << slip;
    before = out.force_W.x();
  }
  EXPECT_LT(before, limit_of(loam, load));
  EXPECT_GT(before, 0.99 * limit_of(loam, load));
  EXPECT_LT(limit_of(loam, load), 0.8 * load);  // rubber on a floor
}

TEST(TyreOnSoil, SlipIsTheSumOfCarcassAndSoil) {
  const scene::Soil loam;
  const double slip = 0.1;
  const TyreForce out = steady(level(loam), Vec2(1 - slip, 0), 1);
  const scene::Wheel tyre = twin();
  const double load = out.force_W.z(), limit = limit_of(loam, load);
  // s = F / (k sigma) + j / l with F = limit (1 - exp(-j / K)) [docs/machines.md, tyres].
  const double carcass = out.force_W.x() / (0.8 * tyre.stiffness * 0.6 * tyre.radius);
  const double j = -loam.janosi_k * std::log(1 - out.force_W.x() / limit);
  const double soil = j / tyre_patch(tyre, loam, load).half_length;
  // 1 %: the implicit step of bristle and soil.
  EXPECT_NEAR(carcass + soil, slip, 0.01 * slip);
}

TEST(TyreOnSoil, SideForceAndPullShareOneLimit) {
  const scene::Soil loam;
  const FunctionGround ground = level(loam);
  const TyreForce straight = steady(ground, Vec2(0.5, 0), 1),
                  askew = steady(ground, Vec2(0.5, 0.5), 1);
  const double limit = limit_of(loam, straight.force_W.z());
  EXPECT_NEAR(straight.force_W.head<2>().norm(), limit, 0.01 * limit);
  EXPECT_NEAR(askew.force_W.head<2>().norm(), limit, 0.01 * limit);
  // Opposite to the slip, which is at 45 deg
  EXPECT_NEAR(-askew.force_W.y() / askew.force_W.x(), 1, 0.01);
}

TEST(TyreOnSoil, SideForceGrowsWithTheSlipAngle) {
  const scene::Soil loam;
  double before = 0;
  for (const double angle : {2.0, 5.0, 10.0, 20.0}) {
    const TyreForce out = steady(level(loam), Vec2(1, std::tan(radians(angle))), 1);
    EXPECT_LT(out.force_W.y(), before) << angle;
    before = out.force_W.y();
  }
}

TEST(TyreOnSoil, TreatsStrongSoilWithoutKAsAFirmFloor) {
  scene::Soil rock;
  rock.cohesion = rock.residual_cohesion = 1e9;
  rock.janosi_k = 1e-9;
  for (const Vec2& carrier : {Vec2(0.98, 0), Vec2(0.9, 0.05), Vec2(0.2, 0.3)}) {
    const Vec3 soft = steady(level(rock), carrier, 1).force_W,
               firm = steady(flat(), carrier, 1).force_W;
    EXPECT_LT((soft - firm).norm(), 1e-6 * firm.norm());
  }
}

TEST(TyreOnSoil, HoldsItsForceAtRestWithoutCreep) {
  const scene::Soil loam;
  const FunctionGround ground = level(loam);
  TyreMotion motion;
  motion.X_WWheel.translation() = Vec3(0, 0, kHeight);
  motion.spin_inertia = 60;
  TyreState state;
  motion.v_W.x() = 0.02;
  // Dragged by 10 mm
  for (int i = 0; i < 300; ++i) tyre_force(twin(), motion, ground, kStep, state);
  motion.v_W.x() = 0;
  const TyreForce first = tyre_force(twin(), motion, ground, kStep, state);
  TyreForce last;
  for (int i = 0; i < 10000; ++i) last = tyre_force(twin(), motion, ground, kStep, state);
  EXPECT_LT(first.force_W.x(), -1000);
  EXPECT_EQ(first.force_W.x(), last.force_W.x());
  EXPECT_GT(state.sheared[0], 0);
}

TEST(TyreOnSoil, ForceIsTheMobilisedShareOfTheLimit) {
  const scene::Wheel tyre = twin();
  const TrackShear soil{10e3, 0.02, 0.2};
  Vec2 bristle = Vec2::Zero();
  double sheared = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec2 f =
        shear_force(tyre, 0.5, Vec2(0.1, 0), 0, soil, 60 / 0.25, kStep, bristle, sheared);
    // Residual of Newton's steps.
    EXPECT_NEAR(-f.x(), soil.limit * mobilised_share(sheared, soil.janosi_k), 1e-4 * soil.limit)
        << i;
  }
}

TEST(TyreOnSoil, ForgetsItsStateInTheAir) {
  const scene::Soil loam;
  TyreMotion motion;
  motion.X_WWheel.translation() = Vec3(0, 0, 0.6);
  TyreState state;
  state.sheared = {0.1, 0.1};
  EXPECT_TRUE(tyre_force(twin(), motion, level(loam), kStep, state).force_W.isZero());
  EXPECT_EQ(state.sheared[0], 0);
}

/// Returns the loss of pull [N] compared with the same ground without sinkage.
double held_back(const GroundQuery& rut, const scene::Soil& soil, double speed, double rim) {
  return steady(level(soil), Vec2(speed, 0), rim).force_W.x() -
         steady(rut, Vec2(speed, 0), rim).force_W.x();
}

TEST(TyreOnSoil, IsHeldBackBySoilPushedAhead) {
  const scene::Soil loam;
  const scene::Wheel tyre = twin();
  const double z = 0.08;
  const FreshRut rut(loam, z);
  const auto pushes = [&](double advance) {
    return 2 * bulldozing({&loam, 1}, tyre.width, tyre.radius, z, advance);
  };
  const double all = 2 * passive_resistance({&loam, 1}, tyre.width, z);
  // 1e-6: the tanh through rest is 1 at this speed up to rounding, forces are differences of larger
  // ones. Free rolling: a fifth to a quarter
  EXPECT_NEAR(held_back(rut, loam, 1, 1), pushes(1), 1e-6 * all);
  EXPECT_GT(pushes(1), 0.15 * all);
  EXPECT_LT(pushes(1), 0.3 * all);
  EXPECT_NEAR(held_back(rut, loam, 1, 0), all, 1e-6 * all);  // locked: all
  EXPECT_NEAR(held_back(rut, loam, 0.7, 1), 0, 1e-6 * all);  // driven, slips away: nothing
  EXPECT_NEAR(held_back(rut, loam, -1, -1), -pushes(1), 1e-6 * all);
}

TEST(TyreOnSoil, PushesNothingAheadWithoutHigherGround) {
  const scene::Soil loam;
  const FreshRut along(loam, 0.08, 1e3);  // back into its own rut
  EXPECT_NEAR(held_back(along, loam, 1, 1), 0, 1e-3);
  const FreshRut second(loam, 1e-4, 0.3);  // one that bore nearly as much before
  EXPECT_LT(held_back(second, loam, 1, 0), 0.02 * held_back(FreshRut(loam, 0.08), loam, 1, 0));
}

TEST(TyreOnSoil, IsNotPushedBackAtRestOrBeyondItsThrust) {
  scene::Soil rigid;
  rigid.cohesion = rigid.residual_cohesion = 1e6;
  const FreshRut rut(rigid, 0.08);
  EXPECT_EQ(held_back(rut, rigid, 0, 0), 0);
  const double load = steady(rut, Vec2(1, 0), 0).force_W.z();
  EXPECT_GT(2 * passive_resistance({&rigid, 1}, twin().width, 0.08), 2 * load);
  EXPECT_LE(held_back(rut, rigid, 1, 0), load);
}

/// Returns level ground, higher by these steps [m] beyond the wheel's left and right.
FunctionGround rut(const scene::Soil& soil, double left, double right) {
  FunctionGround ground([=](double, double y) { return y > 0.4 ? left : y < -0.4 ? right : 0.0; });
  ground.set_soil([&soil](double, double) { return SoilState{&soil, 1}; });
  return ground;
}

/// Returns the sideways force of the side walls in a rut: what `steady` has more than on level
/// ground.
double side_wall(const scene::Soil& soil, double left, double right, const Vec2& carrier) {
  return steady(rut(soil, left, right), carrier, carrier.x()).force_W.y() -
         steady(level(soil), carrier, carrier.x()).force_W.y();
}

TEST(TyreSideWall, MeetsThePassiveResistanceOfTheRutsWall) {
  scene::Soil soil;
  soil.cohesion = soil.residual_cohesion = 4e3;
  const double law = side_wall_resistance({&soil, 1}, twin().radius, 0.08, 0.3);
  EXPECT_GT(law, 500);
  // Against the motion, on the side of the wall that leads.
  EXPECT_NEAR(side_wall(soil, 0.08, 0.08, Vec2(1, 0.3)), -law, 0.01 * law);
  EXPECT_NEAR(side_wall(soil, 0.08, 0.08, Vec2(1, -0.3)), law, 0.01 * law);
  EXPECT_NEAR(side_wall(soil, 0.08, 0.08, Vec2(-1, 0.3)), -law, 0.01 * law);
  EXPECT_EQ(side_wall(soil, 0.08, 0.08, Vec2(1, 0)), 0);
  // A wheel that only moves sideways mobilises all of it, on the way from rest.
  const double whole = side_wall_resistance({&soil, 1}, twin().radius, 0.08, 1e9);
  EXPECT_GT(whole, 1.05 * law);
  EXPECT_NEAR(side_wall(soil, 0.08, 0.08, Vec2(0, 0.5)), -whole, 0.01 * whole);
  EXPECT_LT(std::abs(side_wall(soil, 0.08, 0.08, Vec2(0, 0.005))), 0.15 * whole);
}

TEST(TyreSideWall, MeetsNothingOnAFreeSideAnAslantGroundOrAFirmFloor) {
  scene::Soil soil;
  soil.cohesion = soil.residual_cohesion = 4e3;
  EXPECT_LT(side_wall(soil, 0.08, 0, Vec2(1, 0.3)), -100);
  EXPECT_EQ(side_wall(soil, 0.08, 0, Vec2(1, -0.3)), 0);
  FunctionGround across([](double, double y) { return 0.1 * y; });
  across.set_soil([&soil](double, double) { return SoilState{&soil, 1}; });
  // On a slope across, no side is a wall: the depth of the rut is zero.
  EXPECT_NEAR(steady(across, Vec2(1, 0.3), 1).sinkage, 0, 1e-12);
  const FunctionGround floor([](double, double y) { return std::abs(y) > 0.4 ? 0.08 : 0.0; });
  EXPECT_EQ(steady(floor, Vec2(1, 0.3), 1).force_W, steady(flat(), Vec2(1, 0.3), 1).force_W);
}

TEST(TyreSideWall, NeverExceedsTheLoad) {
  scene::Soil soil;
  soil.cohesion = soil.residual_cohesion = 200e3;
  const double load = steady(level(soil), Vec2(1, 0.3), 1).force_W.z();
  const double force = -side_wall(soil, 0.2, 0.2, Vec2(1, 0.3));
  EXPECT_LE(force, load);
  EXPECT_GT(force, 0.98 * load);
}

}  // namespace
}  // namespace navvy::terramechanics
