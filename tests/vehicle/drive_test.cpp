// SPDX-License-Identifier: Apache-2.0
// Guarantees of a drive command, for every engine and every kind of drive: one set of tests for all
// of them.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "core/saved_state.h"
#include "values.h"
#include "vehicle/drive/drive_line.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::digest;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;

struct Case {
  std::string engine, drive;
  /// Allowed relative error of a turn: tyres of the dynamic engine slip. The kinematic one rolls
  /// exactly, but its velocity is a step's chord, seen along the heading at the step's end: 1 -
  /// cos(w dt / 2).
  double tolerance;
};

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  return info.param.engine + info.param.drive;
}

class Drives : public ::testing::TestWithParam<Case> {
 protected:
  Drives()
      : machine(GetParam().drive == "Ackermann" ? testing::cart() : testing::robot()),
        engine(build()) {}

  std::unique_ptr<PhysicsEngine> build() const {
    std::unique_ptr<PhysicsEngine> built = GetParam().engine == "Bullet"
                                               ? make_bullet_engine(Vec3(0, 0, -kGravity))
                                               : make_kinematic_engine();
    built->add_machine(machine, Pose::Identity());
    return built;
  }
  /// Command for an angle of the equivalent bicycle.
  DriveInput command(double speed, double bicycle = 0) const {
    return {speed, steer_command(machine.drive, bicycle, speed), false};
  }
  LinkState base() const { return engine->link(0, 0); }
  double forward_speed() const { return base().X_WL.linear().col(0).dot(base().v_WL); }

  scene::Machine machine;
  std::unique_ptr<PhysicsEngine> engine;
};

TEST_P(Drives, GoStraightAtTheCommandedSpeedInBothDirections) {
  for (const double speed : {1.0, -0.6}) {
    engine->set_drive(0, command(speed));
    run(*engine, flat(), 5, kStep);
    // 4 %: the governor controls the speed of the wheels; the tyres slip.
    EXPECT_NEAR(forward_speed(), speed, 0.04 * std::abs(speed));
    EXPECT_NEAR(base().w_WL.z(), 0, 1e-3);
    for (std::size_t w = 0; w < machine.wheels.size(); ++w)
      if (machine.wheels[w].driven)
        EXPECT_NEAR(engine->wheel(0, static_cast<int>(w)).spin * machine.wheels[w].radius, speed,
                    0.05 * std::abs(speed));
  }
  EXPECT_NEAR(base().X_WL.translation().y(), 0, 0.01);
}

TEST_P(Drives, TurnOnTheArcOfTheBicycleModelInBothDirections) {
  const double wheelbase = equivalent_bicycle(machine.drive).wheelbase;
  for (const double angle : {0.3, -0.3}) {
    engine->set_drive(0, command(0.8, angle));
    run(*engine, flat(), 10, kStep);  // the governors' slowest mode decays by a factor e per second
    const double radius = forward_speed() / base().w_WL.z(), expected = wheelbase / std::tan(angle);
    print_value("radius of the turn [m]", radius, std::to_string(expected), "v / w of the drive");
    EXPECT_NEAR(radius, expected, GetParam().tolerance * std::abs(expected));
  }
}

TEST_P(Drives, RespectTheirTopSpeed) {
  const double most = scene::powertrain(machine.drive).max_speed;
  engine->set_drive(0, command(10 * most));
  run(*engine, flat(), 8, kStep);
  EXPECT_NEAR(forward_speed(), most, 0.04 * most);  // as above
}

TEST_P(Drives, StandUnderTheBrakeForAnyOtherCommand) {
  engine->set_drive(0, command(1, 0.2));
  run(*engine, flat(), 3, kStep);
  DriveInput stop = command(1, 0.2);
  stop.brake = true;
  engine->set_drive(0, stop);
  run(*engine, flat(), 3, kStep);
  const Vec3 before = base().X_WL.translation();
  run(*engine, flat(), 5, kStep);
  EXPECT_LT((base().X_WL.translation() - before).norm(), 1e-4);  // 0.1 mm in 5 s
  EXPECT_EQ(engine->drive(0).speed, 1);                          // the command is kept
}

TEST_P(Drives, ResumeEqualInTheMiddleOfATurn) {
  engine->set_drive(0, command(0.8, 0.2));
  run(*engine, flat(), 1, kStep);
  const auto resumed = build();
  load_saved(saved(*engine), *resumed);
  EXPECT_EQ(digest(*resumed), digest(*engine));
  for (int j = 0; j < static_cast<int>(machine.joints.size()); ++j)
    EXPECT_EQ(resumed->joint(0, j).effort_limit, engine->joint(0, j).effort_limit);
  run(*engine, flat(), 1, kStep);
  run(*resumed, flat(), 1, kStep);
  EXPECT_EQ(digest(*resumed), digest(*engine));
}

INSTANTIATE_TEST_SUITE_P(AllEngines, Drives,
                         ::testing::Values(Case{"Bullet", "Ackermann", 0.03},
                                           Case{"Kinematic", "Ackermann", 1e-6},
                                           Case{"Bullet", "Differential", 0.03},
                                           Case{"Kinematic", "Differential", 1e-6}),
                         name_of);

class DifferentialDrives : public ::testing::TestWithParam<Case> {};

TEST_P(DifferentialDrives, TurnOnTheSpot) {
  const scene::Machine machine = testing::robot();
  auto engine = GetParam().engine == "Bullet" ? make_bullet_engine(Vec3(0, 0, -kGravity))
                                              : make_kinematic_engine();
  engine->add_machine(machine, Pose::Identity());
  engine->set_drive(0, {0, 1.5, false});
  run(*engine, flat(), 10, kStep);
  EXPECT_NEAR(engine->link(0, 0).w_WL.z(), 1.5, 0.03 * 1.5);
  // The middle between the wheels stays; the ball swings round it. 5 cm: at the start the sides,
  // each with its own governor, share the centripetal force unequally until they settle.
  EXPECT_LT(engine->link(0, 0).X_WL.translation().head<2>().norm(), 0.05);
  // 5 %: the loaded radius is 4 mm less than 100.
  EXPECT_NEAR(engine->wheel(0, 0).spin, -1.5 * 0.2 / 0.1, 0.05 * 3);  // left, backwards
  EXPECT_NEAR(engine->wheel(0, 1).spin, 1.5 * 0.2 / 0.1, 0.05 * 3);
}

INSTANTIATE_TEST_SUITE_P(AllEngines, DifferentialDrives,
                         ::testing::Values(Case{"Bullet", "", 0}, Case{"Kinematic", "", 0}),
                         name_of);

}  // namespace
}  // namespace navvy::vehicle
