// SPDX-License-Identifier: Apache-2.0
// Loose bodies at rest sleep, and wake when they are pushed, approached, or undermined.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/saved_state.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::box;
using testing::flat;
using testing::FunctionGround;
using testing::run;

constexpr double kStep = 1.0 / 600;

std::unique_ptr<PhysicsEngine> boxes(const std::vector<Pose>& places) {
  auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  for (const Pose& place : places) engine->add_machine(box(), place);
  return engine;
}

Pose pose(const PhysicsEngine& engine, int machine) { return engine.link(machine, 0).X_WL; }
bool sleeps(const PhysicsEngine& engine, int machine) {
  const LinkState link = engine.link(machine, 0);
  return link.v_WL.isZero(0) && link.w_WL.isZero(0);
}

TEST(Rest, ASleepingBodyStaysBitIdenticalAndIsSupported) {
  const auto engine = boxes({make_pose(0.3, 0.4, 0.6)});
  run(*engine, flat(), 2, kStep);
  ASSERT_TRUE(sleeps(*engine, 0));
  const Pose X = pose(*engine, 0);
  EXPECT_NEAR(X.translation().z(), 0.5, 0.01);
  Vec3 impulse = Vec3::Zero();
  run(*engine, flat(), 60, kStep,
      [&](double) { impulse += engine->accounts()->ground_impulse(0); });
  EXPECT_TRUE(pose(*engine, 0).isApprox(X, 0));
  EXPECT_NEAR(impulse.z(), 1000 * kGravity * 60, 1e-6 * 1000 * kGravity * 60);
}

TEST(Rest, ABodyThatSlidesSlowlyDoesNotSleep) {
  // 26.565 deg correspond to their friction of 0.5.
  const double angle = radians(27);
  const auto engine =
      boxes({make_pose(2, 0, 2 * std::tan(angle) + 0.5 / std::cos(angle) + 0.001, 0, -angle)});
  run(*engine, testing::slope(angle), 3, kStep);
  EXPECT_FALSE(sleeps(*engine, 0));
  EXPECT_GT((pose(*engine, 0).translation() - Vec3(2, 0, 2 * std::tan(angle))).norm(), 0.1);
}

TEST(Rest, APushWakesABody) {
  const auto engine = boxes({make_pose(0, 0, 0.5)});
  run(*engine, flat(), 2, kStep);
  ASSERT_TRUE(sleeps(*engine, 0));
  engine->apply_impulse(0, 0, Vec3(2000, 0, 0), Vec3::Zero(), Vec3(0, 0, 0.5));
  EXPECT_NEAR(engine->accounts()->momentum(0).x(), 2000, 1e-6);
  run(*engine, flat(), 0.1, kStep);
  EXPECT_GT(pose(*engine, 0).translation().x(), 0.1);
  run(*engine, flat(), 3, kStep);
  EXPECT_TRUE(sleeps(*engine, 0));
  // A force wakes as well, even if friction holds it without motion.
  engine->add_force(0, 0, Vec3(3e4, 0, 0), Vec3(0, 0, 0.5));
  engine->step(kStep, flat());
  EXPECT_NEAR(engine->accounts()->momentum(0).x(), (3e4 - 0.5 * 1000 * kGravity) * kStep, 5);
}

TEST(Rest, DiggingUnderABodyWakesIt) {
  const auto engine = boxes({make_pose(0, 0, 0.5), make_pose(3, 0, 0.5)});
  run(*engine, flat(), 2, kStep);
  ASSERT_TRUE(sleeps(*engine, 0) && sleeps(*engine, 1));
  const Pose other = pose(*engine, 1);
  const FunctionGround pit([](double x, double) { return x < 1.5 ? -0.4 : 0.0; });
  run(*engine, pit, 2, kStep);
  EXPECT_NEAR(pose(*engine, 0).translation().z(), 0.1, 0.01);
  EXPECT_TRUE(sleeps(*engine, 0));
  EXPECT_TRUE(pose(*engine, 1).isApprox(other, 0)) << "the ground under it has not changed";
}

TEST(Rest, AnApproachingBodyWakesOthersAndAStackSleepsTogether) {
  const auto engine = boxes({make_pose(0, 0, 0.5), make_pose(1.5, 0, 0.5)});
  run(*engine, flat(), 2, kStep);
  ASSERT_TRUE(sleeps(*engine, 0));
  // Between the two and above: it falls on both.
  engine->add_machine(box(), make_pose(0.75, 0, 2.5));
  double lowest = 10;
  run(*engine, flat(), 1, kStep,
      [&](double) { lowest = std::min(lowest, pose(*engine, 2).translation().z()); });
  EXPECT_GT(lowest, 1.45) << "it fell through a sleeping body";
  run(*engine, flat(), 4, kStep);
  for (int m = 0; m < 3; ++m) EXPECT_TRUE(sleeps(*engine, m)) << m;
  // The lower one is pulled away: the upper one falls.
  engine->apply_impulse(0, 0, Vec3(-2e4, 0, 0), Vec3::Zero(), pose(*engine, 0).translation());
  run(*engine, flat(), 3, kStep);
  EXPECT_LT(pose(*engine, 2).translation().z(), 1.4);
}

TEST(Rest, AMachineDrivesIntoASleepingBody) {
  auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  scene::Machine light = box();
  light.links[0].mass = 100;
  light.links[0].inertia *= 0.1;
  const int cart = engine->add_machine(testing::cart(), make_pose(0, 0, 0.02));
  const int body = engine->add_machine(light, make_pose(6, 0.97, 0.5));
  run(*engine, flat(), 2, kStep);
  ASSERT_TRUE(sleeps(*engine, body));
  engine->set_drive(cart, {1.5, 0, false});
  run(*engine, flat(), 6, kStep);
  EXPECT_GT(pose(*engine, body).translation().x(), 6.5);
}

TEST(Rest, ASavedSleepingBodyResumesAndWakesEqually) {
  const auto build = [] { return boxes({make_pose(0, 0, 0.5), make_pose(8, 0, 0.5)}); };
  const auto whole = build();
  run(*whole, flat(), 2, kStep);
  ASSERT_TRUE(sleeps(*whole, 0));
  const auto resumed = build();
  // It has moved: its box must have moved with it.
  resumed->apply_impulse(0, 0, Vec3(9000, 0, 0), Vec3::Zero(), Vec3(0, 0, 0.5));
  run(*resumed, flat(), 1, kStep);
  load_saved(saved(*whole), *resumed);
  EXPECT_TRUE(sleeps(*resumed, 0));
  for (PhysicsEngine* engine : {whole.get(), resumed.get()}) {
    engine->apply_impulse(1, 0, Vec3(-12000, 0, 0), Vec3::Zero(), Vec3(8, 0, 0.6));
    run(*engine, flat(), 3, kStep);
  }
  EXPECT_LT(pose(*whole, 0).translation().x(), -0.01) << "nothing approached the sleeping body";
  EXPECT_EQ(testing::digest(*whole), testing::digest(*resumed));
}

}  // namespace
}  // namespace navvy::vehicle
