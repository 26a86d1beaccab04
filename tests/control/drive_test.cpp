// SPDX-License-Identifier: Apache-2.0
// drive_to on a bicycle that rolls without slip, its steering rate limited, its speed following
// with a lag.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/activities/drive_to.h"
#include "control/bicycle.h"
#include "control/ew180_like.h"
#include "control/operator.h"
#include "control/pursuit.h"

namespace navvy::control::testing {
namespace {

constexpr double kStep = Bicycle::kStep;

struct Arrival {
  bool done = false;
  double distance = 0, turned = 0, time = 0;
  Bicycle bicycle;
};

Arrival drive(const DriveTo& goal, const PlanePose& start) {
  scene::Program program;
  program.steps = {goal};
  Operator op(ew180_like(), program);
  Arrival arrival;
  arrival.bicycle.at = start;
  Observation seen;
  seen.joints.resize(4);
  for (; arrival.time < 200 && !op.ended(); arrival.time += kStep) {
    const PlanePose& at = arrival.bicycle.at;
    seen.X_WB = make_pose(at.p.x(), at.p.y(), 0, 0, 0, at.yaw);
    seen.v_WB = arrival.bicycle.speed * Vec3(std::cos(at.yaw), std::sin(at.yaw), 0);
    const Command command = op.update(seen, arrival.time, kStep);
    if (command.drive) arrival.bicycle.step(*command.drive);
  }
  arrival.done = op.done();
  arrival.distance = (arrival.bicycle.at.p - goal.target).norm();
  arrival.turned = std::remainder(arrival.bicycle.at.yaw - goal.heading, 2 * kPi);
  return arrival;
}

DriveTo to(double x, double y, double heading, double speed = 1.2) {
  DriveTo goal;
  goal.target = Vec2(x, y);
  goal.has_heading = true;
  goal.heading = heading;
  goal.speed = speed;
  return goal;
}

TEST(Drive, StopsAtTheTargetFiveMetresAheadWithTheBrakeOn) {
  const Arrival a = drive(to(-4, 0, 0), {Vec2(-9, 0), 0});
  EXPECT_TRUE(a.done);
  // The drive's lag of 0.2 s at creeping speed, and braking 0.02 m short
  EXPECT_LT(a.distance, 0.05);
  EXPECT_LT(std::abs(a.turned), 1e-6);
  EXPECT_TRUE(a.bicycle.braked);
  EXPECT_LT(a.bicycle.fastest, 1.2 + 1e-9);
  // The ramp is 0.5 m/s^2 both ways; the drive's lag overshoots the curve, which then demands up to
  // twice that.
  EXPECT_LT(a.bicycle.most_acceleration, 1.0);
  EXPECT_LT(a.time, 5 / 1.2 + 1.2 / 0.5 + 4);
}

TEST(Drive, GoesBackwardsStraight) {
  const Arrival a = drive(to(-9, 0, 0, -1.0), {Vec2(-4, 0.1), radians(2)});
  EXPECT_TRUE(a.done);
  EXPECT_LT(a.distance, 0.15);  // the scene's default tolerance
  EXPECT_LT(std::abs(a.turned), radians(3));
  EXPECT_LT(a.time, 20);
}

TEST(Drive, ArrivesBesideAndTurned) {
  for (const double side : {1.0, -1.0})
    for (const double x : {0.0, 300.0}) {  // far from the origin it is the same
      const Arrival shifted = drive(to(x + 12, side * 2, 0), {Vec2(x, 0), 0});
      EXPECT_TRUE(shifted.done);
      EXPECT_LT(shifted.distance, 0.15) << side;  // the scene's default tolerance
      EXPECT_LT(std::abs(shifted.turned), radians(3)) << side;
      const Arrival turned = drive(to(x + 10, side * 9, side * kPi / 2), {Vec2(x, 0), 0});
      EXPECT_TRUE(turned.done);
      EXPECT_LT(turned.distance, 0.15) << side;
      EXPECT_LT(std::abs(turned.turned), radians(3)) << side;
    }
}

/// How a drive ended whose machine is pushed aside by `push` [m] in each of its first `pushes`
/// approaches, 1 m before the target, which is too near to steer back.
struct PushedAside {
  StepReport report;
  int pushed = 0;
  bool backed_off = false;
};

PushedAside pushed_aside(int pushes, double push) {
  const DriveTo goal = to(12, 0, 0);
  Operator op(ew180_like(), {{goal}, {}}, "digger");
  Bicycle bicycle;
  Observation seen;
  seen.joints.resize(4);
  PushedAside out;
  bool away = true;  // since the last push, the machine has been further away
  double time = 0;
  for (; time < 300 && !op.ended(); time += kStep) {
    const PlanePose& at = bicycle.at;
    seen.X_WB = make_pose(at.p.x(), at.p.y(), 0, 0, 0, at.yaw);
    seen.v_WB = bicycle.speed * Vec3(std::cos(at.yaw), std::sin(at.yaw), 0);
    const Command command = op.update(seen, time, kStep);
    if (command.drive) bicycle.step(*command.drive);
    out.backed_off = out.backed_off || op.phase() == "back_off";
    away = away || at.p.x() < 9;
    if (out.pushed < pushes && away && at.p.x() > 11) {
      bicycle.at.p.y() += push;
      ++out.pushed;
      away = false;
    }
  }
  out.report = op.present(seen, time);
  return out;
}

TEST(Drive, BacksOffAndComesAgainIfPushedAside) {
  const PushedAside a = pushed_aside(1, 0.6);
  EXPECT_EQ(a.pushed, 1);
  EXPECT_TRUE(a.backed_off);
  EXPECT_EQ(a.report.state, StepState::kDone) << a.report.reason;
  EXPECT_EQ(a.report.reason.find("its first approach ended 0."), 0u) << a.report.reason;
  EXPECT_NE(a.report.reason.find(" m from the target; it backed off and came again"),
            std::string::npos)
      << a.report.reason;
  EXPECT_LT((a.report.place.head<2>() - Vec2(12, 0)).norm(), DriveTo{}.tolerance);
  // Without a push there is nothing to remark.
  const PushedAside free = pushed_aside(0, 0);
  EXPECT_FALSE(free.backed_off);
  EXPECT_EQ(free.report.state, StepState::kDone);
  EXPECT_EQ(free.report.reason, "");
}

TEST(Drive, IsOutOfReachAfterTheLastApproach) {
  const PushedAside a = pushed_aside(9, 0.6);
  EXPECT_EQ(a.pushed, 2);
  EXPECT_TRUE(a.backed_off);
  EXPECT_EQ(a.report.state, StepState::kOutOfReach) << a.report.reason;
  EXPECT_EQ(a.report.reason.find("it stands 0."), 0u) << a.report.reason;
  EXPECT_NE(a.report.reason.find(" m from the target after 2 approaches; allowed are 0.15 m"),
            std::string::npos)
      << a.report.reason;
  EXPECT_GT((a.report.place.head<2>() - Vec2(12, 0)).norm(), DriveTo{}.tolerance);
}

TEST(Drive, FollowsTheStraightLineToATargetWithoutHeading) {
  DriveTo goal;
  goal.target = Vec2(10, 4);
  const Arrival a = drive(goal, {Vec2(0, 0), 0});
  EXPECT_TRUE(a.done);
  EXPECT_LT(a.distance, goal.tolerance);
}

/// A machine that does not move whatever its command: the wheels' spin [rad/s] and the tyres' push
/// [N] are given. It stands 5 m from its target.
StepReport stuck(double spin, const Vec3& push, double speed = 1, double tolerance = 0.15) {
  scene::Machine machine = ew180_like();
  scene::Wheel wheel;
  wheel.joint = machine.joints[0].name;
  wheel.driven = true;
  wheel.radius = 0.5;
  machine.wheels.push_back(wheel);
  // 18 t in total, whatever the masses of the test machine's links.
  for (scene::Link& link : machine.links)
    link.mass = 18000.0 / static_cast<double>(machine.links.size());
  DriveTo goal = to(-4, 0, 0, speed);
  goal.tolerance = tolerance;
  Operator op(machine, {{goal}, {}}, "digger");
  Observation seen;
  seen.joints.resize(machine.joints.size());
  seen.joints[0].velocity = spin;
  seen.tyre_force = push + Vec3(0, 0, 18000 * kGravity);
  seen.X_WB = make_pose(-9, 0, 0, 0, 0, 0);
  double time = 0;
  for (; time < 60 && !op.ended(); time += kStep) op.update(seen, time, kStep);
  return op.present(seen, time);
}

TEST(Drive, IsBlockedByAnObstacle) {
  // With wheels that hold and with wheels that spin: only the resistance matters.
  for (const double spin : {0.0, 2.0}) {
    const StepReport report = stuck(spin, Vec3(25e3, 0, 0));
    EXPECT_EQ(report.state, StepState::kBlocked);
    EXPECT_NEAR(report.end, 5, 0.05);
    EXPECT_EQ(report.reason,
              "it has stood for 5.00 s, 5.00 m from the target: something holds it while its drive "
              "pushes with 25.00 kN");
  }
}

TEST(Drive, IsStalledWhenItsWheelsSpin) {
  const StepReport report = stuck(2, Vec3::Zero());
  EXPECT_EQ(report.state, StepState::kStalled);
  EXPECT_NE(report.reason.find("its wheels have spun for 5.00 m"), std::string::npos)
      << report.reason;
}

TEST(Drive, IsStalledWhenItsWheelsDoNotTurn) {
  const StepReport report = stuck(0, Vec3::Zero());
  EXPECT_EQ(report.state, StepState::kStalled);
  EXPECT_NE(report.reason.find("does not turn its wheels"), std::string::npos) << report.reason;
}

TEST(Drive, IsDoneWhenItIsHeldWithinItsTolerance) {
  for (const double push : {25e3, 0.0}) {
    const StepReport report = stuck(0, Vec3(push, 0, 0), 1, 5);
    EXPECT_EQ(report.state, StepState::kDone) << report.reason;
    // It notices after 5 s, and stands for half a second.
    EXPECT_NEAR(report.end, 5.5, 0.05);
    EXPECT_EQ(report.reason.find("it has stood for 5.00 s, 5.00 m from the target: "), 0u)
        << report.reason;
    EXPECT_NE(report.reason.find("; allowed are 5.00 m"), std::string::npos) << report.reason;
  }
  EXPECT_EQ(stuck(0, Vec3(25e3, 0, 0), 1, 4.99).state, StepState::kBlocked);
}

TEST(Drive, GetsEnoughTimeToCreep) {
  // At 5 mm/s the 5 cm that count as motion take 10 s.
  EXPECT_NEAR(stuck(0, Vec3::Zero(), 0.005).end, 40, 0.1);
}

/// Returns the report of a machine that turns at `rate` [rad/s] and moves at `speed` [m/s] along x,
/// whatever its command.
StepReport drifting(double rate, double speed) {
  Operator op(ew180_like(), {{to(-4, 0, 0, 1)}, {}}, "digger");
  Observation seen;
  seen.joints.resize(ew180_like().joints.size());
  double time = 0;
  for (; time < 120 && !op.ended(); time += kStep) {
    seen.X_WB = make_pose(-9 + speed * time, 0, 0, 0, 0, rate * time);
    op.update(seen, time, kStep);
  }
  return op.present(seen, time);
}

TEST(Drive, IsStalledWhenItMovesWithoutAdvancing) {
  const StepReport spun = drifting(0.5, 0);
  EXPECT_EQ(spun.state, StepState::kStalled);
  EXPECT_NE(spun.reason.find("without advancing on its path"), std::string::npos) << spun.reason;
  // Its yaw is never nearer to that of the line than at the start.
  EXPECT_NEAR(spun.end, 20, 0.1);
}

TEST(Drive, IsNotStalledWhenItCreeps) {
  // Its time limit ends the drive: 30 s and three times the 5 s that 5 m take at 1 m/s.
  const StepReport crept = drifting(0, 0.012);
  EXPECT_EQ(crept.state, StepState::kOutOfTime) << crept.reason;
}

TEST(Pursuit, PredictsTheFinalPose) {
  const auto about = std::get<scene::AckermannDrive>(ew180_like().drive);
  const PlanePose start{Vec2(0, 0), 0};
  // Two metres sideways within four ahead is impossible at a minimum radius of 5 m, and reported.
  for (const auto& [x, reachable] : {std::pair{12.0, true}, std::pair{3.0, false}}) {
    const DriveTo goal = to(x, 2, 0);
    const PlanePose end = Pursuit::of(goal, about, start).end_from(start, about.steer_rate);
    EXPECT_EQ((end.p - goal.target).norm() < goal.tolerance, reachable) << x;
    // The bicycle of this test has a lag.
    EXPECT_NEAR((end.p - drive(goal, start).bicycle.at.p).norm(), 0, 0.08);
  }
}

}  // namespace
}  // namespace navvy::control::testing
