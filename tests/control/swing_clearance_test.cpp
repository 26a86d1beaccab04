// SPDX-License-Identifier: Apache-2.0
// The way of a load: over a heap that is higher than the place beyond it, and nowhere else.
#include "control/swing_clearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "control/dig_pose.h"
#include "control/ew180_like.h"
#include "scene/soil.h"

namespace navvy::control {
namespace {

constexpr double kReach = 6, kFrom = 0.2, kTo = 2.2, kDumpHeight = 0.6;

/// Returns ground with a ridge of this height [m] across the swing, around its middle.
heightfield::Ground ridge(double height) {
  heightfield::Ground::Setup setup;
  setup.nx = setup.ny = 200;
  setup.cell = 0.1;
  setup.origin = Vec2(-10, -10);
  setup.datum = -4;
  scene::Soil loam;
  loam.name = "loam";
  setup.soils = {loam};
  setup.layers = {{"loam", 10}};
  setup.surface = [height](int ix, int iy) {
    const double angle = std::atan2(-10 + 0.1 * (iy + 0.5), -10 + 0.1 * (ix + 0.5));
    return std::abs(angle - 1.1) < 0.3 ? height : 0.0;
  };
  return heightfield::Ground(setup);
}

class SwingClearance : public ::testing::Test {
 protected:
  SwingClearance() {
    swing.from = kFrom;
    swing.to = kTo;
    swing.dump_at = kReach * Vec2(std::cos(kTo), std::sin(kTo));
    swing.X_WS = arm.X_BS();
    swing.X_WS.translation().head<2>().setZero();
    double possible = 0;
    EXPECT_TRUE(dump_pose(arm, swing.X_WS, swing.dump_at, 0, kDumpHeight, low, possible));
  }
  /// Returns the lowest point in W [m] of the bucket over a ridge of this height, as it is carried.
  double over(double height) {
    const heightfield::Ground ground = ridge(height);
    ArmAngles q = low;
    way = swing;
    pass_over(arm, GroundSurfaceView(ground), way, q);
    return lowest_point(arm.forward(q), arm, swing.X_WS);
  }
  const ArmKinematics arm{testing::ew180_like()};
  CarrySwing swing, way;
  ArmAngles low{};
};

TEST_F(SwingClearance, FindsTheHighestGroundOfTheWayOrOfItsFirstPart) {
  const heightfield::Ground ground = ridge(1.5);
  const GroundSurfaceView surface(ground);
  EXPECT_NEAR(highest_on_arc(swing, 1, surface), 1.5, 1e-6);
  EXPECT_NEAR(highest_on_arc(swing, 0.2, surface), 0, 1e-6);
}

TEST_F(SwingClearance, LeavesTheArmWhereTheWayIsFree) {
  EXPECT_EQ(over(0), lowest_point(arm.forward(low), arm, swing.X_WS));
  EXPECT_EQ(over(0.4), over(0));
}

TEST_F(SwingClearance, RaisesTheArmOverARidge) {
  EXPECT_GT(over(1), over(0) + 0.4);
  EXPECT_GT(over(1.6), 1.6 + 0.15);
  EXPECT_EQ(way.to, kTo);
}

TEST_F(SwingClearance, TurnsTheOtherWayRoundWhereTheArmIsNotHighEnough) {
  EXPECT_EQ(over(9), over(0));
  EXPECT_NEAR(way.to, kTo - 2 * kPi, 1e-9);
}

}  // namespace
}  // namespace navvy::control
