// SPDX-License-Identifier: Apache-2.0
// Brakes of joints: the excavator's swing brake and the lock of its oscillating axle, each with its
// own command.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/saved_state.h"
#include "values.h"
#include "vehicle/machines.h"
#include "vehicle/stability.h"

namespace navvy::vehicle {
namespace {

using testing::digest;
using testing::ew180;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

struct Rig {
  explicit Rig(scene::Machine about)
      : machine(std::move(about)), engine(make_bullet_engine(kDown)) {
    engine->add_machine(machine, Pose::Identity());
    swing = machine.joint_index("swing_joint");
    axle = machine.joint_index("front_axle_oscillation");
  }
  double angle(int joint) const { return engine->joint(0, joint).position; }

  scene::Machine machine;
  std::unique_ptr<PhysicsEngine> engine;
  int swing = -1, axle = -1;
};

TEST(JointBrake, OfTheSwingHoldsUpToItsTorqueAndSlipsBeyond) {
  // A couple on the upper structure against the brake alone: the motor is idle meanwhile.
  for (const double share : {0.95, 1.05}) {
    Rig rig(ew180());
    rig.machine.fixed_base = true;
    rig.engine = make_bullet_engine(kDown);
    rig.engine->add_machine(rig.machine, Pose::Identity());
    rig.engine->set_brake(0, rig.swing, true);
    EXPECT_TRUE(rig.engine->joint(0, rig.swing).braked);
    const double torque = share * rig.machine.joints[static_cast<std::size_t>(rig.swing)].brake;
    const int upper = rig.machine.link_index("upper");
    run(*rig.engine, flat(), 2, kStep, [&](double) {
      const Pose X = rig.engine->link(0, upper).X_WL;
      const Vec3 left = X.linear().col(1);
      rig.engine->add_force(0, upper, 0.5 * torque * left, X * Vec3(1, 0, 0));
      rig.engine->add_force(0, upper, -0.5 * torque * left, X * Vec3(-1, 0, 0));
    });
    print_value("swing under the brake [deg]", degrees(rig.angle(rig.swing)),
                share < 1 ? "held" : "slips", "70 kN m");
    if (share < 1)
      EXPECT_LT(std::abs(rig.angle(rig.swing)), radians(0.1));
    else
      EXPECT_GT(rig.angle(rig.swing), radians(2));
  }
}

TEST(JointBrake, HoldsAgainstAnyJointCommand) {
  Rig rig(ew180());
  rig.engine->set_brake(0, rig.swing, true);
  rig.engine->set_joint(0, rig.swing, {JointMode::kVelocity, 0.5});
  run(*rig.engine, flat(), 2, kStep);
  EXPECT_LT(std::abs(rig.angle(rig.swing)), radians(0.1));
  EXPECT_FALSE(rig.engine->joint(0, rig.swing).stalled);
  // Once released, it follows its command.
  rig.engine->set_brake(0, rig.swing, false);
  run(*rig.engine, flat(), 2, kStep);
  EXPECT_GT(rig.angle(rig.swing), 0.5);
  // While swinging, it stops within its torque: w I / T.
  const double speed = rig.engine->joint(0, rig.swing).velocity, before = rig.angle(rig.swing);
  rig.engine->set_brake(0, rig.swing, true);
  run(*rig.engine, flat(), 2, kStep);
  EXPECT_NEAR(rig.engine->joint(0, rig.swing).velocity, 0, 1e-3);
  EXPECT_GT(rig.angle(rig.swing), before);
  EXPECT_LT(rig.angle(rig.swing) - before, speed);
}

TEST(JointBrake, LocksTheOscillatingAxleWhileTheMachineDrives) {
  // A bump of 0.12 m that rises over a metre under the left front pair; the drive's brake is off.
  const auto bump = terramechanics::FunctionGround(
      [](double x, double y) { return y > 0 && x > 3.6 ? std::min(0.12, 0.12 * (x - 3.6)) : 0.0; });
  double roll[2] = {}, turned[2] = {};
  for (const bool locked : {false, true}) {
    Rig rig(ew180());
    run(*rig.engine, bump, 1, kStep);
    rig.engine->set_brake(0, rig.axle, locked);
    rig.engine->set_drive(0, {0.8, 0, false});
    // It stops with the front pair on the bump and the rear one before it; other commands do not
    // affect the lock.
    run(*rig.engine, bump, 2.6, kStep);
    rig.engine->set_drive(0, {0, 0, false});
    run(*rig.engine, bump, 1.5, kStep);
    const LinkState base = rig.engine->link(0, 0);
    ASSERT_GT(base.X_WL.translation().x() + 2.8, 4.0);
    ASSERT_LT(base.X_WL.translation().x(), 3.4);
    roll[locked] = degrees(std::asin(base.X_WL.linear()(2, 1)));
    turned[locked] = degrees(std::abs(rig.angle(rig.axle)));
  }
  print_value("roll with the axle free, locked [deg]", roll[0], std::to_string(roll[1]),
              "bump of 0.12 m on 1.94 m");
  // Free: the axle turns by asin(0.12 / 1.94) = 3.5 deg and the chassis stays; locked: it leans
  // with the front axle.
  EXPECT_LT(std::abs(roll[0]), 0.5);
  EXPECT_GT(turned[0], 1.5);
  EXPECT_GT(roll[1], 0.8);
  EXPECT_LT(turned[1], 0.2);
}

TEST(JointBrake, IsResumedAndHasNoStateWhileReleased) {
  scene::Machine without = ew180();
  for (scene::Joint& joint : without.joints) joint.brake = 0;
  Rig rig(ew180()), plain(without);
  for (Rig* one : {&rig, &plain}) {
    one->engine->set_joint(0, one->swing, {JointMode::kVelocity, 0.4});
    run(*one->engine, flat(), 0.5, kStep);
  }
  EXPECT_EQ(digest(*rig.engine), digest(*plain.engine));
  const std::uint64_t off = digest(*rig.engine);
  rig.engine->set_brake(0, rig.swing, true);
  EXPECT_NE(digest(*rig.engine), off);
  run(*rig.engine, flat(), 0.1, kStep);
  Rig resumed(ew180());
  load_saved(saved(*rig.engine), *resumed.engine);
  EXPECT_TRUE(resumed.engine->joint(0, rig.swing).braked);
  for (Rig* one : {&rig, &resumed}) {
    run(*one->engine, flat(), 0.2, kStep);
    one->engine->set_brake(0, one->swing, false);
    run(*one->engine, flat(), 0.3, kStep);
  }
  EXPECT_EQ(digest(*resumed.engine), digest(*rig.engine));
  // A joint without a brake ignores the command.
  plain.engine->set_brake(0, plain.swing, true);
  EXPECT_FALSE(plain.engine->joint(0, plain.swing).braked);
}

TEST(JointBrake, HoldsAKinematicMachineToo) {
  scene::Machine machine = ew180();
  machine.kinematic = true;
  const auto engine = make_kinematic_engine();
  engine->add_machine(machine, Pose::Identity());
  const int swing = machine.joint_index("swing_joint");
  engine->set_joint(0, swing, {JointMode::kVelocity, 0.5});
  engine->set_brake(0, swing, true);
  run(*engine, flat(), 1, kStep);
  EXPECT_EQ(engine->joint(0, swing).position, 0);
  const auto resumed = make_kinematic_engine();
  resumed->add_machine(machine, Pose::Identity());
  load_saved(saved(*engine), *resumed);
  EXPECT_TRUE(resumed->joint(0, swing).braked);
  engine->set_brake(0, swing, false);
  run(*engine, flat(), 1, kStep);
  EXPECT_NEAR(engine->joint(0, swing).position, 0.5, 1e-9);
}

TEST(TravelBrake, HoldsTheExcavatorOnASlopeUntilReleased) {
  // 12 deg: 36.7 kN of 150 kN.
  const double angle = radians(12);
  const auto hill = testing::slope(angle);
  const scene::Machine machine = ew180();
  const auto engine = make_bullet_engine(kDown);
  engine->add_machine(machine, make_pose(0, 0, 0, 0, -angle, 0));
  run(*engine, hill, 3, kStep);
  const Vec3 before = engine->link(0, 0).X_WL.translation();
  run(*engine, hill, 3, kStep);
  EXPECT_LT((engine->link(0, 0).X_WL.translation() - before).norm(), 1e-3);
  engine->set_drive(0, {0, 0, false});
  // The governor resists, too, but does not hold the position: it creeps within its motor's slip.
  run(*engine, hill, 2, kStep);
  engine->set_drive(0, {0, 0, true});
  run(*engine, hill, 2, kStep);
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 1e-3);
}

}  // namespace
}  // namespace navvy::vehicle
