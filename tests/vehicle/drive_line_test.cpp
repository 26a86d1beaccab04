// SPDX-License-Identifier: Apache-2.0
// Kinds of drive without an engine: closed forms of steering and sides, limits of the governor.
#include "vehicle/drive/drive_line.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/saved_state.h"
#include "vehicle/drive/ackermann.h"
#include "vehicle/drive/differential.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

constexpr double kStep = 1.0 / 600;

TEST(Ackermann, MatchesTheClosedFormAndKeepsTheInnerLimit) {
  const scene::AckermannDrive drive;
  const double R = 8;
  const SteerAngles angles = ackermann(drive, std::atan(drive.wheelbase / R));
  EXPECT_NEAR(std::tan(angles.left), 2.8 / (R - 0.97), 1e-12);
  EXPECT_NEAR(std::tan(angles.right), 2.8 / (R + 0.97), 1e-12);
  const SteerAngles most = ackermann(drive, -1.5);
  EXPECT_NEAR(most.right, -drive.max_steer, 1e-12);
  EXPECT_LT(std::abs(most.left), std::abs(most.right));
}

TEST(Differential, SidesDifferByYawRateTimesTrack) {
  scene::DifferentialDrive drive;
  drive.track = 0.4, drive.max_speed = 2;
  const SideSpeeds sides = side_speeds(drive, {1, 0.5, false});
  EXPECT_NEAR(sides.left, 0.9, 1e-12);
  EXPECT_NEAR(sides.right, 1.1, 1e-12);
  const SideSpeeds spot = side_speeds(drive, {0, -1, false});
  EXPECT_EQ(spot.left, 0.2);
  EXPECT_EQ(spot.right, -0.2);
}

TEST(Differential, SlowsDownOnTheSameArcBeyondItsSpeed) {
  scene::DifferentialDrive drive;
  drive.track = 0.4, drive.max_speed = 1;
  const SideSpeeds sides = side_speeds(drive, {2, 4, false});
  EXPECT_NEAR(sides.right, 1, 1e-12);
  // R = v / w = 0.5 m.
  EXPECT_NEAR(0.5 * (sides.left + sides.right) / ((sides.right - sides.left) / drive.track), 0.5,
              1e-12);
}

TEST(Differential, IndependentWheelsTakeNothingFromEachOther) {
  // Two wheels on each side, all of them to go forwards; the foremost left one is in the air and
  // spins at its speed already.
  scene::DifferentialDrive drive;
  drive.tractive_force = 400, drive.power = 400, drive.max_speed = 1;
  constexpr double kRadius = 0.1;
  const std::vector<DriveWheel> wheels = {{true, true, kRadius, 0.3},
                                          {true, false, kRadius, 0.3},
                                          {true, true, kRadius, -0.3},
                                          {true, false, kRadius, -0.3}};
  const std::vector<WheelTurn> turns = {{true, 1 / kRadius, kRadius, 0.02},
                                        {true, 0, kRadius, 0.02},
                                        {true, 0, kRadius, 0.02},
                                        {true, 0, kRadius, 0.02}};
  const auto torques = [&](scene::DifferentialDrive::SideWheels side_wheels) {
    drive.side_wheels = side_wheels;
    DifferentialLine line(drive, wheels);
    std::vector<double> out;
    for (int i = 0; i < 600; ++i) line.torques({1, 0, false}, turns, 50, kStep, out);
    return out;
  };
  const auto locked = torques(scene::DifferentialDrive::SideWheels::kLocked);
  EXPECT_EQ(locked[0], locked[2]);
  const auto independent = torques(scene::DifferentialDrive::SideWheels::kIndependent);
  // A quarter of the force for each that must still start. The one in the air keeps its own speed,
  // so that its governor, whose commanded speed still rises from zero, slows it down.
  const double most = 0.25 * drive.tractive_force * kRadius;
  EXPECT_LT(independent[0], 0.01 * most);
  for (const std::size_t w : {1u, 2u, 3u}) EXPECT_NEAR(independent[w], most, 1e-9) << w;
  // Nothing couples them.
  EXPECT_TRUE(DifferentialLine(drive, wheels).differentials().empty());
  // On the spot, each wheel turns the way of its side.
  DifferentialLine line(drive, wheels);
  std::vector<double> spot;
  line.torques({0, 1, false}, std::vector<WheelTurn>(4, turns[1]), 50, kStep, spot);
  EXPECT_LT(spot[0], 0);
  EXPECT_EQ(spot[2], spot[0]);
  EXPECT_EQ(spot[1], -spot[0]);
  EXPECT_EQ(spot[3], spot[1]);
}

TEST(DriveLine, EveryKindFollowsTheArcOfItsEquivalentBicycle) {
  scene::DifferentialDrive differential;
  differential.track = 0.4;
  for (const scene::Drive& drive :
       {scene::Drive(scene::AckermannDrive()), scene::Drive(differential)}) {
    SCOPED_TRACE(scene::drive_name(drive));
    scene::Machine machine;
    machine.drive = drive;
    const auto line = make_drive_line(machine);
    const scene::AckermannDrive bicycle = equivalent_bicycle(drive);
    for (const double speed : {0.5, -0.5}) {
      const Roll roll = line->roll({speed, steer_command(drive, 0.3, speed), false});
      EXPECT_NEAR(roll.speed, speed, 1e-12);
      EXPECT_NEAR(roll.yaw_rate, speed * std::tan(0.3) / bicycle.wheelbase, 1e-12);
    }
    const Roll held = line->roll({1, 0.2, true});
    EXPECT_EQ(held.speed, 0);
    EXPECT_EQ(held.yaw_rate, 0);
  }
}

TEST(DriveLine, AssignsEachWheelToItsSide) {
  const auto wheels = drive_wheels(testing::cart());
  ASSERT_EQ(wheels.size(), 4u);
  for (std::size_t w = 0; w < 4; ++w) {
    EXPECT_EQ(wheels[w].left, w % 2 == 0);
    EXPECT_EQ(wheels[w].driven, w >= 2);
  }
}

TEST(DriveLine, HasNoTorqueWhenBrakedAndForgetsItsCommand) {
  const scene::Machine machine = testing::robot();
  const auto line = make_drive_line(machine);
  const std::vector<WheelTurn> turns = {
      {true, 0, 0.1, 0.02}, {true, 0, 0.1, 0.02}, {false, 0, 0.05, 0.01}};
  std::vector<double> torque;
  const std::uint64_t fresh = hash_of(*line).digest();
  for (int i = 0; i < 100; ++i) line->torques({0, 2, false}, turns, 46, kStep, torque);
  EXPECT_GT(torque[1], 0);  // to the left: the right side goes forwards, the left one backwards
  EXPECT_EQ(torque[0], -torque[1]);
  EXPECT_EQ(torque[2], 0);
  line->torques({0, 2, true}, turns, 46, kStep, torque);
  EXPECT_EQ(torque, std::vector<double>(3, 0.0));
  EXPECT_EQ(hash_of(*line).digest(), fresh);  // the wheels are at rest, as at the start
}

TEST(SpeedGovernor, KeepsWithinTractiveForceAndPower) {
  const scene::Powertrain powertrain;
  SpeedGovernor governor;
  DrivenWheels wheels{2, 0.0, 0.5, 1e5, 18000};
  double torque = 0;
  for (int i = 0; i < 3000; ++i) torque = governor.wheel_torque(powertrain, 2, wheels, kStep);
  EXPECT_NEAR(torque * 2 / 0.5, powertrain.tractive_force, 1e-6);
  wheels.spin = 2 / 0.5;
  torque = governor.wheel_torque(powertrain, 2.5, wheels, kStep);
  EXPECT_LE(torque * 2 / 0.5 * 2, powertrain.power * (1 + 1e-12));
}

}  // namespace
}  // namespace navvy::vehicle
