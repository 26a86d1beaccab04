// SPDX-License-Identifier: Apache-2.0
// The steps of a truck: tip, wait_for, wait_load.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/activities/tip.h"
#include "control/activities/wait_for.h"
#include "control/activities/wait_load.h"
#include "control/operator.h"
#include "core/error.h"
#include "core/saved_state.h"

namespace navvy::control {
namespace {

constexpr double kStep = 0.01;  // [s]

/// Two links and the joint that tips one.
scene::Machine truck() {
  scene::Machine machine;
  machine.name = "truck";
  machine.links.resize(2);
  machine.links[0].name = "frame";
  machine.links[1].name = "bed";
  scene::Joint joint;
  joint.name = "tip_joint";
  joint.type = scene::Joint::Type::kRevolute;
  joint.parent = 0;
  joint.child = 1;
  machine.joints.push_back(joint);
  scene::Shell shell;
  shell.name = "bed";
  shell.link = "bed";
  machine.shells.push_back(shell);
  machine.beds.push_back({"bed", "bed", "tip_joint", 3, ""});
  return machine;
}

struct Trial {
  double time = 0, angle = 0;
  double started = -1, ended = -1;  // events of the tip [s]
};

/// Runs a program; the bed follows its command at `rate` [rad/s], up to `stop` [rad].
Trial run(Operator& op, double rate, double stop, Observation seen = {}) {
  Trial out;
  seen.joints.resize(1);
  for (; out.time < 500 && !op.ended(); out.time += kStep) {
    seen.joints[0].position = out.angle;
    const Command command = op.update(seen, out.time, kStep);
    if (op.event() == CycleEvent::kTipStart) out.started = out.time;
    if (op.event() == CycleEvent::kTipEnd) out.ended = out.time;
    // After a program has failed, only the stop command remains.
    if (!command.joints[0] || op.ended()) continue;
    EXPECT_EQ(command.joints[0]->mode, vehicle::JointMode::kPosition);
    const double target = std::min(command.joints[0]->target, stop);
    out.angle += std::clamp(target - out.angle, -rate * kStep, rate * kStep);
  }
  return out;
}

scene::Program program(std::vector<scene::ProgramStep> steps) { return {std::move(steps), {}}; }

TEST(Truck, TipsToTheAngleHoldsItAndReportsWhen) {
  Operator op(truck(), program({Tip{1.2, 2.0}}));
  const Trial tip = run(op, 0.1, 10);
  EXPECT_TRUE(op.done());
  EXPECT_NEAR(tip.angle, 1.2, radians(1));
  EXPECT_EQ(tip.started, 0);
  // 12 s for the lift, 2 s of holding; the target counts as reached one degree before.
  EXPECT_NEAR(tip.ended, 14, 0.3);
}

TEST(Truck, ABedThatSticksEndsTheProgramAsStalled) {
  Operator op(truck(), program({Tip{1.2, 0}, Tip{0, 0}}));
  const Trial tip = run(op, 0.1, 0.5);
  EXPECT_TRUE(op.ended());
  EXPECT_FALSE(op.done());
  EXPECT_LT(tip.ended, 120);
  EXPECT_GT(tip.ended, 20);
  ASSERT_EQ(op.reports().size(), 1u) << "a stuck bed is not lowered as if it had been tipped";
  EXPECT_EQ(op.reports()[0].state, StepState::kStalled);
  // 1.2 - 0.5 rad
  EXPECT_NE(op.reports()[0].reason.find("40.1"), std::string::npos) << op.reports()[0].reason;
}

TEST(Truck, WaitsForAnotherProgramOrOneOfItsSteps) {
  for (const int steps : {2, 0}) {
    Operator op(truck(), program({WaitFor{"digger", steps, 100}}));
    std::map<std::string, ProgramProgress> programs{{"digger", {1, 4}}};
    Observation seen;
    seen.joints.resize(1);
    seen.programs = &programs;
    for (int i = 0; i < 100; ++i) op.update(seen, i * kStep, kStep);
    EXPECT_FALSE(op.done());
    EXPECT_EQ(op.phase(), "wait_for");
    programs["digger"].done = 2;
    op.update(seen, 1, kStep);
    EXPECT_EQ(op.done(), steps == 2);
    programs["digger"].done = 4;
    op.update(seen, 1, kStep);
    EXPECT_TRUE(op.done());
  }
}

TEST(Truck, WaitsForTheCommandedTimeAndNamesTheReason) {
  Operator op(truck(), program({WaitFor{"digger", 0, 3}}), "dumper 7");
  std::map<std::string, ProgramProgress> programs{{"digger", {1, 4}}};
  Observation seen;
  seen.programs = &programs;
  seen.X_WB.translation() = Vec3(5, -2, 0.3);
  EXPECT_NEAR(run(op, 0.1, 10, seen).time, 3, 0.05);
  EXPECT_FALSE(op.done());
  EXPECT_EQ(op.phase(), "out_of_time");
  const StepReport& report = op.reports().at(0);
  EXPECT_EQ(report.state, StepState::kOutOfTime);
  EXPECT_EQ(report.reason, "'digger' has done 1 of the 4 steps waited for after 3.00 s");
  EXPECT_NEAR(report.end, 3, 0.05);
  EXPECT_EQ(report.place, Vec3(5, -2, 0.3));
}

TEST(Truck, DoesNotWaitForAnEventThatCannotOccur) {
  Operator op(truck(), program({WaitFor{"digger", 3}}));
  std::map<std::string, ProgramProgress> programs{{"digger", {1, 4}}};
  Observation seen;
  seen.joints.resize(1);
  seen.programs = &programs;
  op.update(seen, 0, kStep);
  EXPECT_FALSE(op.ended());
  programs["digger"].failed = true;
  op.update(seen, kStep, kStep);
  ASSERT_TRUE(op.ended());
  EXPECT_EQ(op.reports()[0].state, StepState::kBlocked);
}

/// A bed into which soil falls at a rate, from one time to another.
struct Loading {
  double from = 0, until = 0, rate = 0;  // [s], [s], [kg/s]
  /// Runs a program until it ends and returns when that was.
  double run(Operator& op) const {
    Observation seen;
    seen.joints.resize(1);
    double time = 0;
    seen.bed_load = [&] { return rate * std::clamp(time - from, 0.0, until - from); };
    for (; time < 500 && !op.ended(); time += kStep) op.update(seen, time, kStep);
    return time;
  }
};

TEST(Truck, WaitsUntilItIsLoadedAndTheBucketIsAway) {
  Operator op(truck(), program({WaitLoad{1000, 60}}));
  // 970 kg count as loaded: 50 s until the soil comes, 9.7 s, and 6 s for the bucket.
  EXPECT_NEAR((Loading{50, 100, 100}.run(op)), 65.7, 1.1);
  EXPECT_TRUE(op.done());
  ASSERT_EQ(op.reports().size(), 1u);
  EXPECT_EQ(op.reports()[0].measurements.at(0).name, "loaded_kg");
}

TEST(Truck, LeavesWithWhatItHasWhenNothingMoreComes) {
  Operator some(truck(), program({WaitLoad{1000, 60}}));
  EXPECT_NEAR((Loading{50, 55, 100}.run(some)), 115, 1.1);
  EXPECT_TRUE(some.done());
  EXPECT_NE(some.reports().at(0).reason.find("holds 500.00 kg of 1000.00 kg"), std::string::npos)
      << some.reports().at(0).reason;
  Operator none(truck(), program({WaitLoad{1000, 60}}));
  EXPECT_NEAR((Loading{}.run(none)), 60, 1.1);
  EXPECT_EQ(none.reports().at(0).state, StepState::kOutOfTime);
}

TEST(Truck, ResumesWhileItIsLoaded) {
  Operator whole(truck(), program({WaitLoad{1000, 60}})),
      half(truck(), program({WaitLoad{1000, 60}}));
  Observation seen;
  seen.joints.resize(1);
  double load = 0;
  seen.bed_load = [&] { return load; };
  for (int i = 0; i < 3000; ++i, load += 0.1) whole.update(seen, i * kStep, kStep);
  load_saved(saved(whole), half);
  for (int i = 3000; i < 12000; ++i, load += 0.1) {
    whole.update(seen, i * kStep, kStep);
    half.update(seen, i * kStep, kStep);
    ASSERT_EQ(half.ended(), whole.ended()) << i * kStep;
  }
  EXPECT_TRUE(half.done());
  EXPECT_EQ(hash_of(half).digest(), hash_of(whole).digest());
}

TEST(Truck, TipsAndLoadsNeedABed) {
  scene::Machine machine = truck();
  machine.beds.clear();
  EXPECT_THROW(Operator(machine, program({Tip{1, 0}})), InputError);
  EXPECT_THROW(Operator(machine, program({WaitLoad{1, 0}})), InputError);
}

}  // namespace
}  // namespace navvy::control
