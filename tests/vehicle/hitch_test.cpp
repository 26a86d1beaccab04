// SPDX-License-Identifier: Apache-2.0
// Hitches between machines act like a joint in one machine's file, and can be released.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/saved_state.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
// [m] behind the robot's axle, ahead of the trailer's
constexpr double kHook = 0.4, kDrawbar = 0.6;

scene::Machine shipped(const std::string& name) {
  return scene_io::load_machine(navvy::source_dir() + "/vehicles/" + name + "/model.sdf");
}

scene::Hitch drawbar() {
  scene::Hitch hitch;
  hitch.name = "hitch";
  hitch.hook = Vec3(-kHook, 0, 0.15);
  hitch.eye = Vec3(kDrawbar, 0, 0.15);
  hitch.cone = radians(75);
  hitch.twist = radians(40);
  return hitch;
}

/// Robot and trailer, hitched.
std::unique_ptr<PhysicsEngine> train() {
  auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(shipped("robot"), Pose::Identity());
  engine->add_machine(shipped("robot_trailer"), make_pose(-kHook - kDrawbar, 0, 0));
  engine->hitches()->add_hitch(drawbar(), 0, 1);
  return engine;
}

TEST(Hitch, PullsLikeAJointInTheMachine) {
  const auto engine = train(), joined = make_bullet_engine(Vec3(0, 0, -kGravity));
  const scene::Machine robot = shipped("robot"), whole = shipped("robot_with_trailer");
  joined->add_machine(whole, Pose::Identity());
  double apart = 0, deviation = 0;
  // Driven by the wheels' joints, since a governor uses the mass of its own machine. The brake,
  // which would also hold the trailer's wheels if they belong to the machine, is off.
  for (PhysicsEngine* one : {engine.get(), joined.get()}) one->set_drive(0, {0, 0, false});
  for (const std::array<double, 2>& spin :
       {std::array{3.0, 6.0}, std::array{6.0, 4.0}, std::array{0.0, 0.0}}) {
    for (std::size_t side = 0; side < 2; ++side) {
      const char* joint = side == 0 ? "spin_left" : "spin_right";
      engine->set_joint(0, robot.joint_index(joint), {JointMode::kVelocity, spin[side]});
      joined->set_joint(0, whole.joint_index(std::string("robot::") + joint),
                        {JointMode::kVelocity, spin[side]});
    }
    for (int i = 0; i < 1800; ++i) {
      engine->step(kStep, flat());
      joined->step(kStep, flat());
      apart = std::max(apart, engine->hitches()->hitch(0).apart);
      const Vec3 here = engine->link(1, 0).X_WL.translation();
      const Vec3 there =
          joined->link(0, whole.link_index("robot_trailer::chassis")).X_WL.translation();
      deviation = std::max(deviation, (here - there).norm());
    }
  }
  print_value("eye from the hook [m]", apart, "below 0.01 mm", "[docs/machines.md, hitches]");
  print_value("trailer from that of one tree [m]", deviation, "below 1 mm in 9 s",
              "[docs/machines.md, hitches]");
  EXPECT_LT(apart, 1e-5);
  EXPECT_LT(deviation, 1e-3);
}

TEST(Hitch, CarriesVerticalLoadAndDrawsARollingTrailer) {
  const auto engine = train();
  run(*engine, flat(), 2, kStep);
  // The tub's centre is 0.05 m ahead of the axle: 0.05 / 0.6 of the weight of 20 kg rests on the
  // eye.
  EXPECT_NEAR(engine->hitches()->hitch(0).force.z(), -20 * kGravity * 0.05 / kDrawbar, 0.3);
  engine->set_drive(0, {0.5, 0, false});
  run(*engine, flat(), 3, kStep);
  double drawn = 0;
  run(*engine, flat(), 1, kStep,
      [&](double) { drawn += engine->hitches()->hitch(0).force.x() * kStep; });
  const double load = (24 - 20 * 0.05 / kDrawbar) * kGravity;
  print_value("drawbar pull of the trailer [N]", -drawn, std::to_string(0.02 * load) + " +-10 %",
              "rolling resistance 0.02");
  EXPECT_NEAR(-drawn, 0.02 * load, 0.1 * 0.02 * load);
}

TEST(Hitch, ConservesMomentum) {
  // No other contacts: an impulse on one end acts on both.
  const auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(testing::box(), make_pose(0, 0, 50));
  engine->add_machine(testing::box(), make_pose(-3, 0, 50));
  scene::Hitch hitch;
  hitch.hook = Vec3(-1.5, 0, 0);
  hitch.eye = Vec3(1.5, 0, 0);
  engine->hitches()->add_hitch(hitch, 0, 1);
  const Vec3 J(300, 500, -200);
  engine->apply_impulse(0, 0, J, Vec3::Zero(), Vec3(0.3, 0.2, 50.1));
  double worst = 0, apart = 0;
  run(*engine, flat(), 2, kStep, [&](double) {
    worst = std::max(
        worst, (engine->accounts()->momentum(0) + engine->accounts()->momentum(1) - J).norm());
    apart = std::max(apart, engine->hitches()->hitch(0).apart);
  });
  EXPECT_LT(worst, 1e-6 * J.norm());
  EXPECT_LT(apart, 2e-3);
  EXPECT_GT(engine->accounts()->momentum(1).norm(), 0.1 * J.norm());
}

TEST(Hitch, ReleasesAndHitchesAgain) {
  const auto engine = train();
  engine->set_drive(0, {0.5, 0, false});
  run(*engine, flat(), 4, kStep);
  engine->set_drive(0, {0, 0, false});
  run(*engine, flat(), 1, kStep);
  engine->hitches()->set_hitch(0, false);
  const Vec3 left = engine->link(1, 0).X_WL.translation();
  engine->set_drive(0, {0.5, 0, false});
  run(*engine, flat(), 4, kStep);
  // It stays with its drawbar on the ground, without any pull.
  EXPECT_LT((engine->link(1, 0).X_WL.translation() - left).head<2>().norm(), 0.1);
  EXPECT_NEAR(-std::asin(engine->link(1, 0).X_WL.linear()(2, 0)),
              std::asin((0.15 - 0.015) / kDrawbar), radians(3));
  EXPECT_EQ(engine->hitches()->hitch(0).force.norm(), 0);
  EXPECT_GT(engine->hitches()->hitch(0).apart, 1.5);
  try {
    engine->hitches()->set_hitch(0, true);
    FAIL() << "an eye out of reach was hitched";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("within 0.1 m of the hook"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(engine->hitches()->hitch(0).closed);
}

TEST(Hitch, HitchesAnEyeWithinReachSmoothly) {
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(shipped("robot"), Pose::Identity());
  engine->add_machine(shipped("robot_trailer"), make_pose(-kHook - kDrawbar - 0.06, 0.02, 0));
  scene::Hitch hitch = drawbar();
  hitch.closed = false;
  engine->hitches()->add_hitch(hitch, 0, 1);
  engine->step(kStep, flat());
  engine->hitches()->set_hitch(0, true);
  double fastest = 0;
  run(*engine, flat(), 1, kStep,
      [&](double) { fastest = std::max(fastest, engine->link(1, 0).v_WL.norm()); });
  EXPECT_LT(engine->hitches()->hitch(0).apart, 1e-3);
  EXPECT_LT(fastest, 0.8);
}

TEST(Hitch, JackknifesWhenReversing) {
  const auto engine = train();
  engine->set_drive(0, {-0.3, 0.15, false});
  double most = 0;
  run(*engine, flat(), 12, kStep, [&](double) {
    const Vec3 robot = engine->link(0, 0).X_WL.linear().col(0),
               drawn = engine->link(1, 0).X_WL.linear().col(0);
    most = std::max(most, std::acos(std::clamp(robot.dot(drawn), -1.0, 1.0)));
  });
  EXPECT_GT(degrees(most), 70);
  EXPECT_LT(degrees(most), 75.5);
}

TEST(Hitch, ResumesFromASnapshot) {
  const auto first = train(), second = train();
  first->set_drive(0, {0.5, 0.3, false});
  run(*first, flat(), 1, kStep);
  load_saved(saved(*first), *second);
  for (const auto& engine : {first.get(), second.get()}) {
    run(*engine, flat(), 0.5, kStep);
    engine->hitches()->set_hitch(0, false);
    run(*engine, flat(), 0.5, kStep);
  }
  EXPECT_EQ(testing::digest(*first), testing::digest(*second));
  // An open hitch is part of the state, too.
  const auto third = train();
  load_saved(saved(*first), *third);
  EXPECT_FALSE(third->hitches()->hitch(0).closed);
  run(*first, flat(), 0.5, kStep);
  run(*third, flat(), 0.5, kStep);
  EXPECT_EQ(testing::digest(*first), testing::digest(*third));
}

TEST(Hitch, IsRefusedForKinematicMachines) {
  const auto engine = make_kinematic_engine();
  EXPECT_EQ(engine->hitches(), nullptr);
  EXPECT_THROW(require_hitches(*engine), InputError);
}

}  // namespace
}  // namespace navvy::vehicle
