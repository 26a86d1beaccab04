// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/saved_state.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::arm;
using testing::cart;
using testing::digest;
using testing::flat;
using testing::run;

constexpr double kStep = 0.01;

TEST(KinematicEngine, JointsFollowAtTheirRate) {
  auto engine = make_kinematic_engine();
  engine->add_machine(arm(), Pose::Identity());  // 0.6 rad/s
  engine->set_joint(0, 0, {JointMode::kPosition, 1.0});
  engine->set_joint(0, 1, {JointMode::kVelocity, -0.25});
  run(*engine, flat(), 1, kStep);
  EXPECT_NEAR(engine->joint(0, 0).position, 0.6, 1e-12);
  EXPECT_NEAR(engine->joint(0, 1).position, -0.25, 1e-12);
  const LinkState before = engine->link(0, 2);
  engine->step(1e-6, flat());
  const LinkState after = engine->link(0, 2);
  const Vec3 difference = (after.X_WL.translation() - before.X_WL.translation()) / 1e-6;
  EXPECT_LT((difference - after.v_WL).norm(), 1e-5);
  run(*engine, flat(), 2, kStep);
  EXPECT_NEAR(engine->joint(0, 0).position, 1.0, 1e-12);
  EXPECT_TRUE(engine->inverse_mass(0, 2).isZero());
}

TEST(KinematicEngine, DrivesTheExactArc) {
  auto engine = make_kinematic_engine();
  const scene::Machine m = cart();
  engine->add_machine(m, Pose::Identity());
  const double radius = 7;
  engine->set_drive(0, {1.0, std::atan(std::get<scene::AckermannDrive>(m.drive).wheelbase / radius), false});
  const auto ground = testing::slope(radians(5));
  run(*engine, ground, radius * kPi / 2, kStep);
  const Pose X = engine->link(0, 0).X_WL;
  // 1e-3: half a step at both ends.
  EXPECT_NEAR(X.translation().x(), radius, 5e-3);
  EXPECT_NEAR(X.translation().y(), radius, 5e-3);
  EXPECT_NEAR(X.translation().z(), ground.height(X.translation().x(), X.translation().y()), 1e-9);
  EXPECT_NEAR(engine->wheel(0, 2).spin, 1 / 0.525, 1e-9);
  EXPECT_GT(engine->wheel(0, 0).steer, engine->wheel(0, 1).steer);
}

TEST(KinematicEngine, ResumesEqual) {
  const auto build = [] {
    auto engine = make_kinematic_engine();
    engine->add_machine(cart(), make_pose(1, 2, 0, 0, 0, 0.5));
    engine->set_drive(0, {0.7, 0.2, false});
    return engine;
  };
  auto whole = build();
  run(*whole, flat(), 1, kStep);
  auto resumed = build();
  load_saved(saved(*whole), *resumed);
  run(*whole, flat(), 1, kStep);
  run(*resumed, flat(), 1, kStep);
  EXPECT_EQ(digest(*whole), digest(*resumed));
}

}  // namespace
}  // namespace navvy::vehicle
