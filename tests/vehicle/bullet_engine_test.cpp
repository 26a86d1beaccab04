// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <cmath>

#include "core/error.h"
#include "core/saved_state.h"
#include "vehicle/kinematics.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::arm;
using testing::cart;
using testing::digest;
using testing::ew180;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

TEST(BulletEngine, LinkPosesAgreeWithForwardKinematicsWhileTheMachineMoves) {
  auto engine = make_bullet_engine(kDown);
  const scene::Machine m = arm();
  engine->add_machine(m, Pose::Identity());
  engine->set_joint(0, 0, {JointMode::kPosition, 0.4});
  engine->set_joint(0, 1, {JointMode::kVelocity, -0.3});
  const auto ground = flat();
  Pose before = engine->link(0, 2).X_WL;
  run(*engine, ground, 0.5, kStep, [&](double) {
    const auto poses = forward_kinematics(
        m, Pose::Identity(), {engine->joint(0, 0).position, engine->joint(0, 1).position});
    const LinkState link = engine->link(0, 2);
    EXPECT_TRUE(link.X_WL.isApprox(poses[2], 1e-9));
    // 1e-3 m/s: the difference over one step is of first order in it.
    EXPECT_LT(((link.X_WL.translation() - before.translation()) / kStep - link.v_WL).norm(), 2e-3);
    before = link.X_WL;
  });
}

TEST(BulletEngine, HoldTorqueMatchesTheClosedForm) {
  auto engine = make_bullet_engine(kDown);
  const scene::Machine m = arm();
  engine->add_machine(m, Pose::Identity());
  engine->set_joint(0, 0, {JointMode::kPosition, 0.3});
  engine->set_joint(0, 1, {JointMode::kPosition, -1.1});
  const auto ground = flat();
  run(*engine, ground, 6, kStep);
  const auto poses = forward_kinematics(m, Pose::Identity(), {0.3, -1.1});
  const auto moment = [&](const Vec3& pivot, std::size_t link) {
    return m.links[link].mass * kGravity * ((poses[link] * m.links[link].p_LCom).x() - pivot.x());
  };
  const double boom = moment(poses[1].translation(), 1) + moment(poses[1].translation(), 2);
  const double stick = moment(poses[2].translation(), 2);
  EXPECT_NEAR(engine->joint(0, 0).position, 0.3, 1e-5);
  // 1e-5: residual of the solver's iterations.
  EXPECT_NEAR(engine->joint(0, 0).effort, boom, 1e-5 * boom);
  EXPECT_NEAR(engine->joint(0, 1).effort, stick, 1e-5 * std::abs(boom));
}

TEST(BulletEngine, ServoStopsWithinItsLimitsWithoutOvershoot) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(arm(), Pose::Identity());
  engine->set_joint(0, 0, {JointMode::kPosition, 0.8});
  const auto ground = flat();
  double fastest = 0, furthest = 0;
  run(*engine, ground, 4, kStep, [&](double) {
    fastest = std::max(fastest, engine->joint(0, 0).velocity);
    furthest = std::max(furthest, engine->joint(0, 0).position);
    EXPECT_LE(std::abs(engine->joint(0, 0).effort), 500e3 * 1.0001);
  });
  EXPECT_LE(fastest, 0.6 * 1.001);
  EXPECT_GT(fastest, 0.55);
  EXPECT_LT(furthest, 0.8 + 2e-3);
  EXPECT_NEAR(engine->joint(0, 0).position, 0.8, 1e-4);
}

TEST(BulletEngine, OverloadedJointYieldsAndReportsTheStall) {
  auto engine = make_bullet_engine(kDown);
  scene::Machine m = arm();
  m.joints[0].effort = 30e3;  // needs about 70 kN m
  m.joints[0].has_limits = true;
  m.joints[0].lower = -0.5;
  m.joints[0].upper = 1;
  engine->add_machine(m, Pose::Identity());
  engine->set_joint(0, 0, {JointMode::kPosition, 0.5});
  const auto ground = flat();
  run(*engine, ground, 4, kStep);
  EXPECT_TRUE(engine->joint(0, 0).stalled);
  // Rests on its lower limit.
  EXPECT_NEAR(engine->joint(0, 0).position, -0.5, 5e-3);
  EXPECT_NEAR(engine->joint(0, 0).effort, 30e3, 1);
}

TEST(BulletEngine, FreeJointsSwingAsAPendulum) {
  auto engine = make_bullet_engine(kDown);
  scene::Machine m = arm();
  m.joints[0].initial = radians(-90) + 0.05;
  engine->add_machine(m, Pose::Identity());
  engine->set_joint(0, 0, {JointMode::kFree, 0});
  engine->set_joint(0, 1, {JointMode::kPosition, 0});
  const auto ground = flat();
  // Both links as one physical pendulum about the boom's pivot.
  const double i_boom = m.links[1].inertia(1, 1) + 1200 * (2.5 * 2.5 + 0.3 * 0.3);
  const double i_stick = m.links[2].inertia(1, 1) + 600 * 6.2 * 6.2;
  const Vec3 moment = 1200 * Vec3(2.5, 0, 0.3) + 600 * Vec3(6.2, 0, 0);
  const double rest = radians(-90) - std::atan2(moment.z(), moment.x());
  const double period = 2 * kPi * std::sqrt((i_boom + i_stick) / (kGravity * moment.norm()));
  std::vector<double> crossings;
  double last = m.joints[0].initial;
  run(*engine, ground, 3.2 * period, kStep, [&](double t) {
    const double q = engine->joint(0, 0).position;
    if ((last - rest) * (q - rest) < 0) crossings.push_back(t);
    last = q;
  });
  ASSERT_GE(crossings.size(), 5u);
  // 0.5 %: amplitude of 0.15 rad lengthens it by 0.14 %, crossings are known to a step.
  EXPECT_NEAR(crossings[4] - crossings[0], 2 * period, 0.005 * 2 * period);
}

TEST(BulletEngine, AnImpulseChangesTheMomentumByItsValue) {
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(ew180(), make_pose(3, 2, 5, 0.1, 0.2, 0.3));
  const auto ground = testing::FunctionGround([](double, double) { return -100.0; });
  run(*engine, ground, 0.05, kStep);
  const Vec3 J(300, -500, 700), L(40, 50, -60);
  for (const char* name : {"chassis", "bucket", "wheel_front_left"}) {
    const int link = ew180().link_index(name);
    const Vec3 before = engine->accounts()->momentum(0);
    engine->apply_impulse(0, link, J, L, engine->link(0, link).X_WL * Vec3(0.3, 0.2, 0.1));
    EXPECT_LT((engine->accounts()->momentum(0) - before - J).norm(), 1e-9 * J.norm()) << name;
  }
  EXPECT_TRUE(engine->accounts()->external_impulse(0).isApprox(3 * J));
}

TEST(BulletEngine, InverseMassPredictsTheVelocityChangeOfAnImpulse) {
  const scene::Machine m = ew180();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, make_pose(0, 0, 0, 0, 0, 0.7));
  const auto ground = flat();
  run(*engine, ground, 0.1, kStep);
  for (const char* name : {"bucket", "chassis", "knuckle_left"}) {
    const int link = m.link_index(name);
    const Mat6 inverse = engine->inverse_mass(0, link);
    EXPECT_TRUE(inverse.isApprox(inverse.transpose(), 1e-12));
    EXPECT_GT(inverse.eigenvalues().real().minCoeff(), 0);
    for (int c = 0; c < 6; ++c) {
      const LinkState before = engine->link(0, link);
      Vec6 wrench = Vec6::Zero();
      wrench[c] = 100;
      engine->apply_impulse(0, link, wrench.tail<3>(), wrench.head<3>(), before.X_WL.translation());
      const LinkState after = engine->link(0, link);
      Vec6 change;
      change << after.w_WL - before.w_WL, after.v_WL - before.v_WL;
      EXPECT_TRUE(change.isApprox(inverse * wrench, 1e-9)) << name << " " << c;
    }
  }
}

TEST(BulletEngine, RepeatedAndResumedRunsAreEqual) {
  const auto ground = testing::FunctionGround([](double x, double) { return 0.1 * std::sin(x); });
  const auto build = [&] {
    auto engine = make_bullet_engine(kDown);
    engine->add_machine(ew180(), Pose::Identity());
    engine->add_machine(ew180(), make_pose(0, 6, 0.3));
    engine->add_machine(testing::box(), make_pose(5, 0, 2, 0.3, 0.2, 0.1));
    return engine;
  };
  const auto drive = [&](PhysicsEngine& engine, double from, double to) {
    const int steps = static_cast<int>(std::lround((to - from) / kStep));
    for (int i = 0; i < steps; ++i) {
      const double t = from + i * kStep;
      engine.set_drive(0, {1.0, 0.3 * std::sin(t), false});
      engine.set_joint(1, 7, {JointMode::kPosition, t});
      if (i % 16 == 0)
        engine.apply_impulse(0, 11, Vec3(10, 20, 30), Vec3::Zero(),
                             engine.link(0, 11).X_WL.translation());
      engine.step(kStep, ground);
    }
  };
  auto whole = build();
  drive(*whole, 0, 1);
  const std::vector<char> bytes = saved(*whole);
  drive(*whole, 1, 2);

  auto again = build();
  drive(*again, 0, 1);
  drive(*again, 1, 2);
  EXPECT_EQ(digest(*whole), digest(*again));

  auto resumed = build();
  load_saved(bytes, *resumed);
  drive(*resumed, 1, 2);
  EXPECT_EQ(digest(*whole), digest(*resumed));
  // The state is not constant: another second changes it.
  drive(*resumed, 2, 2.1);
  EXPECT_NE(digest(*whole), digest(*resumed));
}

TEST(BulletEngine, ReportsInvalidInput) {
  auto engine = make_bullet_engine(kDown);
  scene::Machine m = arm();
  m.links[1].mass = 0;
  EXPECT_THROW(engine->add_machine(m, Pose::Identity()), InputError);
  m = arm();
  m.joints.pop_back();
  EXPECT_THROW(engine->add_machine(m, Pose::Identity()), InputError);
  engine->add_machine(arm(), Pose::Identity());
  EXPECT_THROW(engine->step(0, flat()), SimulationError);
}

}  // namespace
}  // namespace navvy::vehicle
