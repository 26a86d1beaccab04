// SPDX-License-Identifier: Apache-2.0
// Ball joints with stops: a drawbar leans and twists within the limits of its hitch.

#include <gtest/gtest.h>

#include <cmath>

#include "core/saved_state.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

constexpr double kStep = 1.0 / 600;

/// A fixed post and 100 kg with equal moments of inertia, 1 m along x of a ball joint. Frames are
/// rotated against each other, so that no axis coincides with another one.
scene::Machine hitch(double cone, double twist) {
  scene::Machine m;
  m.name = "hitch";
  m.fixed_base = true;
  m.links.push_back(testing::box_link("post", make_pose(0, 0, 5, 0.3, 0.2, 0.1), 100, Vec3::Zero(),
                                      Vec3(1, 2, 3)));
  const Pose X_MJ = make_pose(0, 0, 5, 0, 0, 0.4), X_ML = X_MJ * make_pose(0, 0, 0, 0.5, -0.2, 0.7);
  const Pose X_LJ = X_ML.inverse() * X_MJ;
  m.links.push_back(testing::box_link("bar", X_ML, 100, X_LJ * Vec3(1, 0, 0), Vec3::Constant(0.5)));
  scene::Joint ball = testing::revolute("ball", 0, 1, Vec3::UnitZ());
  ball.type = scene::Joint::Type::kBall;
  ball.X_LcJ = X_LJ;
  ball.cone = cone;
  ball.twist = twist;
  m.joints.push_back(ball);
  return m;
}

/// Motion of the bar since the start: lean of its x axis and twist about it [deg].
struct Bend {
  double lean, turn;
};
Bend bend(const PhysicsEngine& engine, const scene::Machine& m) {
  const Mat3 R_WJ0 = (m.links[1].X_ML * m.joints[0].X_LcJ).linear();
  const Mat3 R = R_WJ0.transpose() * (engine.link(0, 1).X_WL * m.joints[0].X_LcJ).linear();
  const Eigen::Quaterniond q(R);
  return {degrees(std::atan2(std::hypot(R(1, 0), R(2, 0)), R(0, 0))),
          degrees(2 * std::atan2(q.x(), q.w()))};
}

TEST(BallLimits, HoldABarThatFalls) {
  for (const double cone : {20.0, 60.0}) {
    const scene::Machine m = hitch(radians(cone), kPi);
    const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
    engine->add_machine(m, Pose::Identity());
    double worst = 0;
    testing::run(*engine, testing::flat(), 3, kStep,
                 [&](double) { worst = std::max(worst, bend(*engine, m).lean); });
    // 0.1 deg: the rotation of one step at the stop.
    EXPECT_NEAR(bend(*engine, m).lean, cone, 0.1);
    EXPECT_LT(worst, cone + 0.2);
  }
}

TEST(BallLimits, HoldABarThatIsTurned) {
  const scene::Machine m = hitch(kPi, radians(35));
  for (const double sign : {1.0, -1.0}) {
    const auto engine = make_bullet_engine(Vec3::Zero());
    engine->add_machine(m, Pose::Identity());
    testing::run(*engine, testing::flat(), 2, kStep, [&](double) {
      // A couple of 10 N m about the bar.
      const Pose X = engine->link(0, 1).X_WL * m.joints[0].X_LcJ;
      const Vec3 lever = X.linear() * Vec3(0, 0.5, 0), force = X.linear() * Vec3(0, 0, 10 * sign);
      engine->add_force(0, 1, force, X * Vec3(1, 0, 0) + lever);
      engine->add_force(0, 1, -force, X * Vec3(1, 0, 0) - lever);
    });
    EXPECT_NEAR(bend(*engine, m).turn, 35 * sign, 0.1);
    EXPECT_LT(bend(*engine, m).lean, 1);
  }
}

TEST(BallLimits, DoNotActOnAFreeBall) {
  const scene::Machine m = hitch(kPi, kPi);
  const auto engine = make_bullet_engine(Vec3(0, 0, -kGravity));
  engine->add_machine(m, Pose::Identity());
  double worst = 0;
  testing::run(*engine, testing::flat(), 2, kStep,
               [&](double) { worst = std::max(worst, bend(*engine, m).lean); });
  // A pendulum released level swings to the other side.
  EXPECT_GT(worst, 170);
}

TEST(BallLimits, ResumeBitIdentically) {
  const scene::Machine m = hitch(radians(20), radians(10));
  const auto first = make_bullet_engine(Vec3(0, 0, -kGravity)),
             second = make_bullet_engine(Vec3(0, 0, -kGravity));
  first->add_machine(m, Pose::Identity());
  second->add_machine(m, Pose::Identity());
  testing::run(*first, testing::flat(), 1, kStep);
  load_saved(saved(*first), *second);
  testing::run(*first, testing::flat(), 0.5, kStep);
  testing::run(*second, testing::flat(), 0.5, kStep);
  EXPECT_EQ(testing::digest(*first), testing::digest(*second));
}

}  // namespace
}  // namespace navvy::vehicle
