// SPDX-License-Identifier: Apache-2.0
// The step go_to with the real planner, on a bicycle and a ground that changes during the drive. No
// OpenCL.
#include "control/activities/go_to.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "control/activities/wait.h"
#include "control/bicycle.h"
#include "control/operator.h"
#include "control/reach.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "log_lines.h"
#include "planner/footprint.h"
#include "planner/map_path_planner.h"
#include "planner/sites.h"
#include "scene/drive_kinds.h"
#include "values.h"

namespace navvy::planner {
namespace {

using control::GoTo;
using control::StepState;
using control::testing::Bicycle;
using testing::dig;
using testing::excavator;
using testing::fill;
using testing::level_site;

const Vec2 kLow(-1, -2), kHigh(1.5, 5);  // a trench across the path

GoTo to(double x, double y, double heading) {
  GoTo step;
  step.target = Vec2(x, y);
  step.heading = heading;
  return step;
}

scene::Machine crawler() {
  return scene_io::load_machine(navvy::source_dir() + "/vehicles/ex180_tracked/model.sdf");
}

/// An excavator's operator on a separate site.
struct Trip {
  explicit Trip(std::vector<scene::ProgramStep> program, double x = -8,
                const scene::Machine& machine = excavator())
      : op(machine, {std::move(program), {}}, "digger", path_planners()),
        ground(level_site()),
        crawls(scene::differential_drive(machine.drive) != nullptr),
        footprint(footprint_of(machine)) {
    bicycle.at = {Vec2(x, 0), 0};
    seen.joints.resize(machine.joints.size());
    seen.ground = &ground;
  }
  void step() {
    const control::PlanePose& at = bicycle.at;
    seen.X_WB = make_pose(at.p.x(), at.p.y(), 0, 0, 0, at.yaw);
    seen.v_WB = bicycle.speed * Vec3(std::cos(at.yaw), std::sin(at.yaw), 0);
    const control::Command command = op.update(seen, time, Bicycle::kStep);
    if (command.drive && !crawls) bicycle.step(*command.drive);
    if (command.drive && crawls) crawl(*command.drive);
    time += Bicycle::kStep;
    if (++steps % 20 == 0) poses.push_back(bicycle.at);
  }
  /// A crawler's tracks follow their command at once and do not slip.
  void crawl(const vehicle::DriveInput& input) {
    bicycle.braked = input.brake;
    bicycle.speed = input.brake ? 0 : input.speed;
    const double turn = input.brake || (held && input.speed == 0) ? 0 : input.steer;
    bicycle.at.p +=
        bicycle.speed * Bicycle::kStep * Vec2(std::cos(bicycle.at.yaw), std::sin(bicycle.at.yaw));
    bicycle.at.yaw += turn * Bicycle::kStep;
    if (bicycle.speed == 0) turned += std::abs(turn) * Bicycle::kStep;
  }
  void run(
      double until, const std::function<void()>& each = [] {}) {
    while (time < until && !op.ended()) {
      step();
      each();
    }
  }
  /// Least clearance of the machine on its whole path, on the present ground.
  double least_clearance() const {
    map::MapMaker maker{map::MapOptions()};
    maker.update(ground.view());
    const map::TerrainMap map = maker.map();
    double least = 1;
    for (const control::PlanePose& at : poses)
      least = std::min(least, clearance(map, footprint, at.p.x(), at.p.y(), at.yaw, 1));
    return least;
  }
  double value_of(const std::string& name) const {
    for (const control::Measurement& each : op.reports().back().measurements)
      if (each.name == name) return each.value;
    return NAN;
  }

  control::Operator op;
  heightfield::Ground ground;
  Bicycle bicycle;
  control::Observation seen;
  std::vector<control::PlanePose> poses;
  double time = 0;
  int steps = 0;
  bool crawls = false;
  bool held = false;  ///< a crawler does not turn on the spot
  Footprint footprint;
  double turned = 0;  ///< on the spot [rad]
};

class GoToStep : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!path_planners())
      GTEST_SKIP() << "no OMPL in this build: install libompl-dev and build with NAVVY_WITH_OMPL";
  }
};

void expect_arrived(const Trip& trip, const GoTo& goal) {
  ASSERT_TRUE(trip.op.done()) << trip.op.reports().back().reason;
  EXPECT_LT((trip.bicycle.at.p - goal.target).norm(), 0.5);
  EXPECT_LT(std::abs(std::remainder(trip.bicycle.at.yaw - goal.heading, 2 * kPi)), radians(5));
  EXPECT_TRUE(trip.bicycle.braked);
  print_value("distance from the goal [m]", trip.value_of("goal_error_m"), "< 0.5", "tolerance");
  print_value("least clearance [m]", trip.least_clearance(), ">= 0.3", "asked for");
  EXPECT_GE(trip.least_clearance(), 0.3);
}

/// Returns true if the footprint sweeps over the trench along the path.
bool crosses(const control::Path& path) {
  for (double s = 0; s < path.length(); s += 0.1) {
    const Vec2 p = path.at(s).p;
    if ((p.array() > kLow.array()).all() && (p.array() < kHigh.array()).all()) return true;
  }
  return false;
}

TEST_F(GoToStep, DrivesAroundATrenchDugAfterPlanning) {
  // Dug while the machine is driving, and while its program still waits.
  for (const double when : {4.0, 1.0}) {
    const GoTo goal = to(9, 0, 0);
    Trip trip({control::Wait(2), goal});
    bool dug = false;
    trip.run(200, [&] {
      if (!dug && trip.time >= when) dig(trip.ground, kLow, kHigh), dug = true;
    });
    expect_arrived(trip, goal);
    ASSERT_EQ(trip.op.paths().size(), 2u) << when;
    EXPECT_TRUE(crosses(trip.op.paths()[0].path));
    EXPECT_FALSE(crosses(trip.op.paths()[1].path));
    EXPECT_EQ(trip.op.paths()[0].time, 0);
    EXPECT_EQ(trip.value_of("plans"), 2);
    EXPECT_GE(trip.value_of("least_clearance_m"), 0.3);
  }
}

TEST_F(GoToStep, ArrivesWithAnyHeadingOverCusps) {
  for (const double yaw : {kPi, -kPi / 2}) {
    const GoTo goal = to(6, 3, yaw);
    Trip trip({goal});
    dig(trip.ground, kLow, Vec2(1.5, 1));
    trip.run(300);
    expect_arrived(trip, goal);
    ASSERT_EQ(trip.op.paths().size(), 1u);
    EXPECT_EQ(trip.value_of("cusps"), trip.op.paths()[0].path.cusps());
  }
}

TEST_F(GoToStep, StaysWhenItIsAtTheGoal) {
  Trip trip({to(-7.8, 0.1, radians(2))});
  trip.run(5);
  EXPECT_TRUE(trip.op.done());
  EXPECT_EQ(trip.bicycle.fastest, 0);
}

TEST_F(GoToStep, WaitsWithoutAPathAndEndsWithThatReason) {
  GoTo goal = to(9, 0, 0);
  goal.retry = 3;
  goal.tries = 3;
  goal.iterations = 100;
  Trip trip({goal});
  dig(trip.ground, Vec2(-1, -13), Vec2(1.5, 13));
  trip.run(30);
  ASSERT_TRUE(trip.op.ended());
  const control::StepReport& report = trip.op.reports().back();
  EXPECT_EQ(report.state, StepState::kNoPath);
  EXPECT_STREQ(name_of(report.state), "no_path");
  EXPECT_EQ(trip.op.phase(), "no_path");
  EXPECT_NEAR(report.end, 2 * 3, 0.1);
  EXPECT_EQ(
      report.reason.rfind("no path from (-8.00 , 0.00 ) to (9.00 , 0.00 ) that keeps 0.30 m", 0),
      0u)
      << report.reason;
  EXPECT_NE(report.reason.find("100 iterations found none, try 3 of 3"), std::string::npos)
      << report.reason;
  EXPECT_EQ(trip.bicycle.fastest, 0);
}

TEST_F(GoToStep, ContinuesWhenThereIsAPathAgain) {
  GoTo goal = to(9, 0, 0);
  goal.retry = 3;
  goal.iterations = 200;
  Trip trip({goal});
  dig(trip.ground, Vec2(-1, -13), Vec2(1.5, 13));
  trip.run(4);
  EXPECT_EQ(trip.op.phase(), "no_path");
  fill(trip.ground, Vec2(-1, -13), Vec2(1.5, 0));
  trip.run(200);
  expect_arrived(trip, goal);
}

TEST_F(GoToStep, ReportsWhyThereIsNoPath) {
  GoTo goal = to(9, 0, 0);
  goal.tries = 1;
  Trip stuck({goal});
  dig(stuck.ground, Vec2(-9, -1), Vec2(-8, 1));
  stuck.run(5);
  EXPECT_NE(stuck.op.reports().back().reason.find("it stands on some"), std::string::npos)
      << stuck.op.reports().back().reason;
  Trip taken({goal});
  dig(taken.ground, Vec2(9, -1), Vec2(10, 1));
  taken.run(5);
  EXPECT_NE(taken.op.reports().back().reason.find("the goal lies 0.00 m from some"),
            std::string::npos);
}

TEST_F(GoToStep, DrivesAwayFromATrenchThatIsNearerThanItsClearance) {
  GoTo goal = to(9, -4, 0);
  Trip trip({goal});
  // The left side of the machine is 1.27 m from its middle.
  dig(trip.ground, Vec2(-14, 1.5), Vec2(2, 3));
  trip.run(200);
  ASSERT_TRUE(trip.op.done()) << trip.op.reports().back().reason;
  const double least = trip.least_clearance();
  print_value("least clearance [m]", least, "> 0, < 0.3", "it starts nearer than asked for");
  EXPECT_LT(least, 0.3);
  EXPECT_GT(least, 0);
  // The check of the remaining path accepts what the planner has found.
  EXPECT_EQ(trip.value_of("plans"), 1);
}

TEST_F(GoToStep, RepeatsAndResumesBitIdentically) {
  const std::vector<scene::ProgramStep> program = {control::Wait(1), to(9, 0, 0)};
  const auto digest = [](Trip& trip) { return hash_of(trip.op).digest(); };
  Trip whole(program), again(program);
  dig(whole.ground, kLow, kHigh);
  dig(again.ground, kLow, kHigh);
  whole.run(12);
  again.run(12);
  EXPECT_EQ(whole.op.phase(), "drive");
  EXPECT_EQ(digest(whole), digest(again));
  Trip resumed(program);
  dig(resumed.ground, kLow, kHigh);
  load_saved(saved(whole.op), resumed.op);
  resumed.bicycle = whole.bicycle;
  resumed.time = whole.time;
  EXPECT_EQ(digest(resumed), digest(whole));
  EXPECT_EQ(resumed.op.paths().size(), whole.op.paths().size());
  // A wall on the path makes both plan again.
  dig(whole.ground, Vec2(3, -12), Vec2(4, 2));
  dig(resumed.ground, Vec2(3, -12), Vec2(4, 2));
  for (int i = 0; i < 40000 && !whole.op.ended(); ++i) {
    whole.step();
    resumed.step();
    if (i % 100 == 0) ASSERT_EQ(digest(resumed), digest(whole)) << whole.time;
  }
  EXPECT_TRUE(whole.op.ended());
  EXPECT_EQ(digest(resumed), digest(whole));
  EXPECT_EQ(resumed.bicycle.at.p, whole.bicycle.at.p);
}

/// Returns the faults of the step on a level site with a trench at its goal.
std::vector<Fault> faults_of(const GoTo& step, const control::MakePathPlanner& planners) {
  heightfield::Ground ground = level_site();
  dig(ground, Vec2(8, -1), Vec2(10, 1));
  return control::check_reach(excavator(), {{step}, {17}}, make_pose(-8, 0, 0),
                              control::GroundSurfaceView(ground), "mine.sdf", "digger", planners);
}

TEST_F(GoToStep, ACrawlerTurnsOnTheSpotRatherThanToAndFro) {
  // Three metres aside.
  const GoTo goal = to(-8, 3, 0);
  Trip trip({goal}, -8, crawler());
  trip.run(60);
  expect_arrived(trip, goal);
  EXPECT_EQ(trip.value_of("plans"), 1);
  EXPECT_EQ(trip.value_of("cusps"), 0);
  EXPECT_NEAR(trip.value_of("driven_m"), 3, 0.1);
  EXPECT_NEAR(degrees(trip.turned), 180, 5);
  EXPECT_LT(trip.value_of("goal_error_deg"), 1);
  // At the goal with another heading.
  const GoTo about = to(-8, 0, radians(-60));
  Trip turn({about}, -8, crawler());
  turn.run(60);
  expect_arrived(turn, about);
  EXPECT_EQ(turn.value_of("plans"), 0);
  EXPECT_EQ(turn.bicycle.at.p, Vec2(-8, 0));
  // A machine on wheels does not.
  Trip wheels({goal});
  wheels.run(120);
  expect_arrived(wheels, goal);
  EXPECT_GT(wheels.value_of("driven_m"), 4);
}

TEST_F(GoToStep, ACrawlerKeepsItsClearanceWhileItTurns) {
  // A wall beside it leaves space for the machine, but not for its corners.
  const GoTo goal = to(-8, 0, radians(180));
  Trip trip({goal}, -8, crawler());
  dig(trip.ground, Vec2(-18, 2.0), Vec2(18, 6));
  trip.run(300);
  expect_arrived(trip, goal);
  EXPECT_GE(trip.value_of("plans"), 1) << "it drives to where it can turn";
}

TEST_F(GoToStep, ACrawlerThatIsHeldInATurnDrivesAPath) {
  const LogLines log;
  const GoTo goal = to(-8, 0, radians(120));
  Trip trip({goal}, -8, crawler());
  trip.held = true;
  trip.run(300);
  EXPECT_NE(log.text().find("it does not turn on the spot: it plans a path"), std::string::npos);
  expect_arrived(trip, goal);
  EXPECT_EQ(trip.turned, 0);
}

TEST_F(GoToStep, ACrawlerStopsATurnWhenTheGroundBesideItHasChanged) {
  const LogLines log;
  const GoTo goal = to(-8, 0, radians(180));
  Trip trip({goal}, -8, crawler());
  trip.run(2);  // while it turns
  ASSERT_GT(trip.turned, 0.1);
  // Beside it as it stands now: its tail would swing over the trench.
  const double yaw = trip.bicycle.at.yaw;
  dig(trip.ground, Vec2(-18, 2.6), Vec2(18, 6));
  trip.run(4);
  EXPECT_NE(log.text().find("beside it has changed: planning again"), std::string::npos);
  EXPECT_LT(trip.bicycle.at.yaw - yaw, radians(10));
}

TEST_F(GoToStep, ACrawlerResumesBitIdenticallyInATurn) {
  const GoTo goal = to(-8, 3, 0);
  Trip whole({goal}, -8, crawler()), first({goal}, -8, crawler());
  whole.run(60);
  first.run(2);  // while it turns
  ASSERT_GT(first.turned, 0.1);
  ASSERT_EQ(first.bicycle.speed, 0);
  Trip second({goal}, -8, crawler());
  load_saved(saved(first.op), second.op);
  second.bicycle = first.bicycle;
  second.time = first.time;
  second.run(60);
  EXPECT_EQ(second.bicycle.at.p, whole.bicycle.at.p);
  EXPECT_EQ(second.bicycle.at.yaw, whole.bicycle.at.yaw);
  EXPECT_EQ(second.time, whole.time);
}

TEST_F(GoToStep, IsRefusedBeforeTheRunIfTheGoalIsOnAnObstacle) {
  EXPECT_TRUE(faults_of(to(0, 5, 0), path_planners()).empty());
  const std::vector<Fault> faults = faults_of(to(9, 0, 0), path_planners());
  ASSERT_EQ(faults.size(), 1u);
  const std::string text = faults[0].text();
  for (const char* part :
       {"mine.sdf:17", "digger/navvy:program/step 1/go_to/target", "(9.00 , 0.00 )",
        "would stand 0.00 m from ground that it cannot drive on", "choose another goal"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in " << text;
  // The machine is 3.8 m long ahead of its origin: this goal is on the site, its front is not.
  EXPECT_EQ(faults_of(to(15, -6, 0), path_planners()).size(), 1u);
}

TEST(GoTo, IsRefusedWithoutAPlanner) {
  const std::vector<Fault> faults = faults_of(to(0, 5, 0), {});
  ASSERT_EQ(faults.size(), 1u);
  const std::string text = faults[0].text();
  for (const char* part :
       {"mine.sdf:17", "go_to", "nobody plans paths here", "-DNAVVY_WITH_OMPL=ON", "libompl-dev"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in " << text;
  EXPECT_THROW(control::Operator(excavator(), {{to(0, 5, 0)}, {}}), InputError);
}

}  // namespace
}  // namespace navvy::planner
