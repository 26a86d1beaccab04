// SPDX-License-Identifier: Apache-2.0
// Limits of a wheel by Bekker's and Janosi's laws.
#include "terramechanics/rigid_wheel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "terramechanics/bearing.h"

namespace navvy::terramechanics {
namespace {

scene::Soil plain() {
  scene::Soil soil;
  soil.friction_angle = radians(30);
  soil.tool_friction_angle = radians(20);
  soil.cohesion = soil.residual_cohesion = soil.adhesion = 0;
  soil.bekker_kc = 0;
  soil.bekker_kphi = 1e6;
  soil.bekker_n = 1;
  soil.janosi_k = 0.02;
  return soil;
}

TEST(RigidWheel, SmoothWheelSinksByBekkersClosedForm) {
  // n = 1, no shear, small entry angle: W = (2/3) k b sqrt(2 r) z^(3/2).
  scene::Soil soil = plain();
  soil.tool_friction_angle = 0;
  const WheelForce force = rigid_wheel({0.5, 0.2, 300, 0.3}, soil);
  const double z = std::pow(300 / (2.0 / 3 * 1e6 * 0.2 * std::sqrt(1.0)), 2.0 / 3);
  EXPECT_NEAR(force.sinkage, z, 0.02 * z);
  EXPECT_NEAR(force.torque, 0, 1e-12);
  // Towed with the work of compacting the rut: b k z^2 / 2 per metre.
  EXPECT_NEAR(-force.drawbar, 0.5 * 1e6 * 0.2 * force.sinkage * force.sinkage,
              0.01 * -force.drawbar);
}

TEST(RigidWheel, SinksByBekkersClosedFormInMeasuredSand) {
  // z = (3 W / ((3 - n) b k sqrt(D)))^(2 / (2 n + 1)) [Bekker 1956], for small entry angles: 26.0
  // mm.
  scene::Soil sand = plain();
  sand.tool_friction_angle = 0;
  sand.bekker_kphi = 1734000, sand.bekker_n = 1.34;
  // Entry angle 53 degrees
  EXPECT_NEAR(rigid_wheel({0.0625, 0.06, 24.6, 0}, sand).sinkage, 0.0260, 0.05 * 0.0260);
}

TEST(RigidWheel, SpinningWheelMobilisesTheRimsFriction) {
  scene::Soil soil = plain();
  soil.janosi_k = 1e-5;  // fully mobilised
  const WheelForce force = rigid_wheel({0.5, 0.2, 300, 0.9}, soil);
  // The rim's forces act within the entry angle of the vertical, so the torque is r tan delta load,
  // a few percent less.
  EXPECT_NEAR(force.torque, 0.5 * std::tan(radians(20)) * 300,
              0.05 * 0.5 * std::tan(radians(20)) * 300);
  EXPECT_GT(force.drawbar, 0);
}

TEST(RigidWheel, LockedWheelResistsByItsFriction) {
  const WheelForce force = rigid_wheel({0.5, 0.2, 300, -1}, plain());
  EXPECT_LT(force.drawbar, -std::tan(radians(20)) * 300);
  EXPECT_LT(force.torque, 0);
}

TEST(RigidWheel, PushesSoilAheadUnlessItSlips) {
  const scene::Soil soil = plain();
  EXPECT_EQ(rigid_wheel({0.5, 0.2, 300, 0.3}, soil).bulldozing, 0);
  double before = 0;
  for (const double slip : {0.0, -0.2, -0.5, -1.0}) {
    const WheelForce force = rigid_wheel({0.5, 0.2, 300, slip}, soil);
    EXPECT_GT(force.bulldozing, before) << slip;
    before = force.bulldozing;
  }
  // Fully locked: without cohesion b gamma z^2 Kgamma / 2 with tan phi' = 2/3 tan 30 deg, Nq' 8.31,
  // Ngamma' 5.13.
  const WheelForce locked = rigid_wheel({0.5, 0.2, 300, -1}, soil);
  const double tan_phi = 2.0 / 3 * std::tan(radians(30));
  const double k_gamma = (2 * 5.13 / tan_phi + 1) / (1 + tan_phi * tan_phi);
  const double expected =
      0.2 * 0.5 * soil.bank_density * kGravity * locked.sinkage * locked.sinkage * k_gamma;
  EXPECT_NEAR(locked.bulldozing, expected, 0.01 * expected);
}

TEST(RigidWheel, PullGrowsWithSlip) {
  double before = -1e9;
  for (const double slip : {-1.0, -0.5, -0.2, 0.0, 0.1, 0.3, 0.6}) {
    const double pull = rigid_wheel({0.5, 0.2, 300, slip}, plain()).drawbar;
    EXPECT_GT(pull, before) << slip;
    before = pull;
  }
}

TEST(RigidWheel, SinksDeeperBySlipByLyaskosLaw) {
  scene::Soil soil = plain();
  soil.tool_friction_angle = 0;
  const double rolling = rigid_wheel({0.5, 0.2, 300, 0}, soil).sinkage;
  for (const double slip : {0.2, 0.5, -0.5}) {
    const double s = std::abs(slip), deeper = (1 + s) / (1 - 0.5 * s);
    WheelCase wheel{0.5, 0.2, 300, slip};
    EXPECT_EQ(rigid_wheel(wheel, soil).sinkage, rolling);
    wheel.slip_sinkage = 1;
    // 2 %: Bekker's power holds for small entry angles.
    EXPECT_NEAR(rigid_wheel(wheel, soil).sinkage, deeper * rolling, 0.02 * deeper * rolling)
        << slip;
  }
}

TEST(RigidWheel, SideForceGrowsWithTheSlipAngleAtTheCostOfPull) {
  double side = 0, pull = 1e9;
  for (const double angle : {0.0, 2.0, 5.0, 10.0, 20.0, 40.0}) {
    WheelCase wheel{0.5, 0.2, 300, 0.3};
    wheel.slip_angle = radians(angle);
    const WheelForce force = rigid_wheel(wheel, plain());
    if (angle > 0) {
      EXPECT_GT(force.side, side) << angle;
      EXPECT_LT(force.drawbar, pull) << angle;
    } else {
      EXPECT_EQ(force.side, 0);
    }
    side = force.side, pull = force.drawbar;
    // 5 %: pressure stands off the plumb line.
    EXPECT_LT(side - force.side_wall, std::tan(radians(20)) * 300 * 1.05);
  }
}

TEST(RigidWheel, SideWallMeetsThePassiveResistanceOfItsSegment) {
  scene::Soil soil = plain();
  soil.cohesion = soil.residual_cohesion = 5e3;
  soil.janosi_k = 1e-6;  // fully mobilised
  WheelCase wheel{0.5, 0.2, 3000, 0};
  wheel.slip_angle = radians(20);
  const WheelForce force = rigid_wheel(wheel, soil);
  // A shallow segment is a parabola of depth z over the chord l: the mean depth is 2/3 z, the mean
  // square 8/15 z^2.
  const double z = force.sinkage, l = 2 * std::sqrt((1.0 - z) * z);
  const double unit = passive_resistance({&soil, 1}, 1, 1),
               half = passive_resistance({&soil, 1}, 1, 0.5);
  const double by_weight = 2 * (unit - 2 * half), by_cohesion = unit - by_weight;
  const double expected = l * (by_cohesion * 2 / 3 * z + by_weight * 8 / 15 * z * z);
  EXPECT_NEAR(force.side_wall, expected, 0.02 * expected);
  // Straight ahead it meets nothing, and less angle mobilises less.
  soil.janosi_k = 0.02;
  const double partly = rigid_wheel(wheel, soil).side_wall;
  EXPECT_LT(partly, force.side_wall);
  wheel.slip_angle = radians(5);
  EXPECT_LT(rigid_wheel(wheel, soil).side_wall, partly);
  wheel.slip_angle = 0;
  EXPECT_EQ(rigid_wheel(wheel, soil).side_wall, 0);
}

TEST(RigidWheel, GrousersShearSoilOnSoil) {
  WheelCase wheel{0.5, 0.2, 300, 0.3};
  const double smooth = rigid_wheel(wheel, plain()).drawbar;
  wheel.grouser = 0.02;
  EXPECT_GT(rigid_wheel(wheel, plain()).drawbar,
            smooth + 0.5 * (std::tan(radians(30)) - std::tan(radians(20))) * 300);
}

TEST(RigidWheel, DrawbarPeaksWhenSlipIncreasesSinkage) {
  double best = -1e9, at = 0, last = 0;
  for (double slip = 0; slip < 0.96; slip += 0.05) {
    WheelCase wheel{0.5, 0.2, 2000, slip};
    wheel.slip_sinkage = 1;
    last = rigid_wheel(wheel, plain()).drawbar;
    if (last > best) best = last, at = slip;
  }
  EXPECT_GT(at, 0.05);
  EXPECT_LT(at, 0.6);
  EXPECT_LT(last, best - 10);
}

TEST(RigidWheel, ReportsWhenTheGroundCannotCarryTheLoad) {
  scene::Soil mud = plain();
  mud.bekker_kphi = 1000;
  EXPECT_FALSE(rigid_wheel({0.5, 0.2, 3000, 0}, mud).carried);
}

}  // namespace
}  // namespace navvy::terramechanics
