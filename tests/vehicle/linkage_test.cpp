// SPDX-License-Identifier: Apache-2.0
// The steering trapezoid closes, is mirror symmetric, and has the error known from textbooks.
#include "vehicle/drive/linkage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

/// Arms of 0.2 m that lean by tan b = t / L, behind or ahead.
scene::LinkageDrive trapezoid(bool ahead = false) {
  scene::LinkageDrive drive;
  drive.ahead = ahead;
  for (int i = 0; i < 60; ++i) {
    const double lean = std::atan(drive.tie_rod / drive.wheelbase);
    drive.tie_rod = drive.track + (ahead ? 2 : -2) * drive.arm * std::sin(lean);
  }
  return drive;
}

/// Length of the tie rod between the arms' ends [m].
double rod(const scene::LinkageDrive& drive, const SteerAngles& angles) {
  const Vec2 arm = scene::steering_arm(drive);
  const Vec2 left = Vec2(0, 0.5 * drive.track) + Eigen::Rotation2Dd(angles.left) * arm;
  const Vec2 right =
      Vec2(0, -0.5 * drive.track) + Eigen::Rotation2Dd(angles.right) * Vec2(arm.x(), -arm.y());
  return (left - right).norm();
}

TEST(Linkage, ClosesAtEveryPositionOfItsMotor) {
  for (const bool ahead : {false, true}) {
    scene::LinkageDrive drive = trapezoid(ahead);
    drive.gear_ratio = 12;
    const MotorRange range = motor_range(drive);
    double last = -10;
    for (double share = 0; share <= 1; share += 0.01) {
      const SteerAngles angles =
          linkage_angles(drive, range.right + share * (range.left - range.right));
      EXPECT_NEAR(rod(drive, angles), drive.tie_rod, 1e-12) << share;
      EXPECT_GT(angles.right, last) << "the right wheel follows the left one";
      EXPECT_LE(std::max(std::abs(angles.left), std::abs(angles.right)), drive.max_steer + 1e-12);
      last = angles.right;
    }
    EXPECT_NEAR(linkage_angles(drive, 1e9).left, drive.max_steer, 1e-12);
    EXPECT_NEAR(linkage_angles(drive, -1e9).right, -drive.max_steer, 1e-9);
  }
}

TEST(Linkage, IsMirrorSymmetric) {
  const scene::LinkageDrive drive = trapezoid();
  const SteerAngles left = linkage_angles(drive, radians(20));
  const SteerAngles right = linkage_angles(drive, -left.right);
  EXPECT_NEAR(right.right, -left.left, 1e-12);
}

TEST(Linkage, OfAParallelogramTurnsBothWheelsEqually) {
  scene::LinkageDrive drive;
  drive.tie_rod = drive.track;
  const SteerAngles angles = linkage_angles(drive, radians(25));
  EXPECT_NEAR(angles.right, radians(25), 1e-12);
  const double ideal = std::atan(1 / (1 / std::tan(radians(25)) + drive.track / drive.wheelbase));
  EXPECT_NEAR(ackermann_error(drive, angles), radians(25) - ideal, 1e-12);
}

// Series of the closed form: outer = inner - k inner^2 + ..., for the trapezoid k = tan b W / t,
// for Ackermann W / L.
TEST(Linkage, MatchesItsSeriesToSecondOrder) {
  const double small = radians(0.5);
  for (const double tie_rod : {1.94, 1.86, 1.77, 1.72}) {
    scene::LinkageDrive drive;
    drive.tie_rod = tie_rod;
    const Vec2 arm = scene::steering_arm(drive);
    const double k = arm.y() / arm.x() * drive.track / tie_rod;
    const SteerAngles angles = linkage_angles(drive, small);
    EXPECT_NEAR((angles.left - angles.right) / (small * small), k, 0.01) << tie_rod;
    EXPECT_NEAR(ackermann_error(drive, angles) / (small * small), drive.track / drive.wheelbase - k,
                0.01)
        << tie_rod;
  }
}

TEST(Linkage, WithArmsTowardsTheRearAxleIsNearlyAckermann) {
  const scene::LinkageDrive drive = trapezoid();
  const auto error = [&](double inner) {
    return degrees(ackermann_error(drive, linkage_angles(drive, radians(inner))));
  };
  EXPECT_LT(std::abs(error(5)), 0.02);
  EXPECT_LT(std::abs(error(20)), 1);
  EXPECT_EQ(error(0), 0);
  // Ackermann's own angles have no error.
  EXPECT_NEAR(ackermann_error(drive, ackermann(drive, -0.3)), 0, 1e-12);
}

TEST(Linkage, TheMotorFollowsTheBicycleAngle) {
  scene::LinkageDrive linkage = trapezoid();
  linkage.gear_ratio = 5;
  scene::Machine machine;
  machine.drive = linkage;
  const auto line = make_drive_line(machine);
  for (const double angle : {-0.4, -0.1, 0.0, 0.2, 0.45}) {
    const double motor = steer_command(machine.drive, angle, 1);
    const Roll roll = line->roll({1.5, motor, false});
    EXPECT_NEAR(roll.yaw_rate, 1.5 * std::tan(angle) / linkage.wheelbase, 1e-9) << angle;
  }
  // No farther than its stops.
  EXPECT_NEAR(steer_command(machine.drive, 1.5, 1), motor_range(linkage).left, 1e-9);
}

TEST(Linkage, DetectsLockingOrUnreachablePositions) {
  EXPECT_TRUE(scene::turns_freely(trapezoid()));
  scene::LinkageDrive drive = trapezoid();
  drive.tie_rod = drive.track - 2.1 * drive.arm;
  EXPECT_FALSE(scene::turns_freely(drive));
  // An inverted trapezoid, with arms that lean in by 30 deg ahead of the axle: by the law of
  // cosines the right one is in line with the tie rod, together as long as the track, when the left
  // one has turned by 30 deg - asin(a / 2 W).
  drive = trapezoid();
  drive.ahead = true;
  drive.tie_rod = drive.track - drive.arm;
  const double locked = radians(30) - std::asin(0.5 * drive.arm / drive.track);
  drive.max_steer = locked - radians(0.1);
  EXPECT_TRUE(scene::turns_freely(drive));
  drive.max_steer = locked + radians(0.1);
  EXPECT_FALSE(scene::turns_freely(drive));
}

TEST(Linkage, SteersACartOnTheArcOfItsAngles) {
  scene::Machine cart = testing::cart();
  scene::LinkageDrive linkage = trapezoid();
  static_cast<scene::AckermannDrive&>(linkage) = std::get<scene::AckermannDrive>(cart.drive);
  cart.drive = linkage;
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(cart, make_pose(0, 0, 0.02));
  const double motor = steer_command(cart.drive, 0.25, 1);
  engine->set_drive(0, {1, motor, false});
  double turned = 0, time = 0;
  testing::run(*engine, testing::flat(), 12, 1.0 / 600, [&](double t) {
    if (t > 6) turned += engine->link(0, 0).w_WL.z() / 600, time += 1.0 / 600;
  });
  EXPECT_NEAR(turned / time, std::tan(0.25) / linkage.wheelbase,
              0.03 * std::tan(0.25) / linkage.wheelbase);
}

}  // namespace
}  // namespace navvy::vehicle
