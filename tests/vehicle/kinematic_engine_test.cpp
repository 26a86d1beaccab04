// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
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
  engine->set_drive(
      0, {1.0, std::atan(std::get<scene::AckermannDrive>(m.drive).wheelbase / radius), false});
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

TEST(KinematicEngine, MovesToAPlaceAtConstantSpeedAndReportsItsTwist) {
  auto engine = make_kinematic_engine();
  engine->add_machine(arm(), make_pose(1, 2, 0.5));
  EXPECT_EQ(engine->placement()->base(0).p_W, Vec3(1, 2, 0.5));
  engine->placement()->set_base(0, {Vec3(2, 2, 0.5), Vec3(0, 0, 4), 0.5});
  run(*engine, flat(), 0.25, kStep);
  const LinkState half = engine->link(0, 0);
  EXPECT_NEAR(half.X_WL.translation().x(), 1.5, 1e-12);
  EXPECT_NEAR(half.v_WL.x(), 2, 1e-9);
  // The shorter way round: 4 rad are 2.28 to the right.
  EXPECT_NEAR(half.w_WL.z(), (4 - 2 * kPi) / 0.5, 1e-9);
  EXPECT_NEAR(std::atan2(half.X_WL.linear()(1, 0), half.X_WL.linear()(0, 0)), 0.5 * (4 - 2 * kPi),
              1e-12);
  run(*engine, flat(), 0.5, kStep);
  const LinkState there = engine->link(0, 0);
  EXPECT_EQ(there.X_WL.matrix(), make_pose(2, 2, 0.5, 0, 0, 4).matrix());
  EXPECT_TRUE(there.v_WL.isZero() && there.w_WL.isZero());
  // At once in all six coordinates, including its links.
  engine->placement()->set_base(0, {Vec3(0, 1, 2), Vec3(0.1, -0.2, 0.3), 0});
  engine->step(kStep, flat());
  EXPECT_EQ(engine->link(0, 0).X_WL.matrix(), make_pose(0, 1, 2, 0.1, -0.2, 0.3).matrix());
  EXPECT_LT((engine->link(0, 2).X_WL.translation() - Vec3(0, 1, 2)).norm(), 9);
}

TEST(KinematicEngine, PlacesABaseUntilItsDriveIsCommanded) {
  const auto build = [] {
    auto engine = make_kinematic_engine();
    engine->add_machine(cart(), Pose::Identity());
    return engine;
  };
  auto whole = build(), resumed = build();
  whole->set_drive(0, {1, 0, false});
  whole->placement()->set_base(0, {Vec3(0, 3, 1), Vec3(0, 0, 0), 1});
  run(*whole, flat(), 0.5, kStep);
  load_saved(saved(*whole), *resumed);
  for (PhysicsEngine* engine : {whole.get(), resumed.get()}) run(*engine, flat(), 1, kStep);
  EXPECT_EQ(digest(*resumed), digest(*whole));
  EXPECT_EQ(whole->link(0, 0).X_WL.translation(), Vec3(0, 3, 1));
  whole->set_drive(0, {1, 0, false});
  run(*whole, flat(), 1, kStep);
  // On the ground again, continuing from its placed position.
  EXPECT_LT((whole->link(0, 0).X_WL.translation() - Vec3(1, 3, 0)).norm(), 1e-9);
}

TEST(KinematicEngine, IsTheOnlyEngineThatPlacesABase) {
  auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(testing::box(), make_pose(0, 0, 1));
  EXPECT_EQ(engine->placement(), nullptr);
  EXPECT_THROW(require_placement(*engine, 0), InputError);
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
