// SPDX-License-Identifier: Apache-2.0
// Ends of steps and programs: a state, a reason and an account that survive a snapshot.
#include "control/outcome.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "control/activities/wait.h"
#include "control/activity.h"
#include "control/activity_step.h"
#include "control/ew180_like.h"
#include "control/operator.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "flip_bytes.h"

namespace navvy::control::testing {
namespace {

constexpr double kStep = 0.01;  // [s]

/// Turns the boom and drives, reports an account, and fails after a while if commanded to.
struct Trying final : ActivityStep {
  StepState end = StepState::kDone;
  const char* element() const override { return "trying"; }
  void describe(scene::Fields&) override {}
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

class TryingHard final : public Activity {
 public:
  TryingHard(OperatorContext& place, const Trying& step) : Activity(place), step_(step) {}
  const char* phase() const override { return "try"; }
  void begin(const Observation&) override {}
  std::vector<Measurement> account(const Observation& seen) const override {
    return {{"way_m", seen.X_WB.translation().x()}, {"tried_s", phase_time()}};
  }

 private:
  bool update(const Observation&, double, Command& out) override {
    out.joints[1] = vehicle::JointInput{vehicle::JointMode::kPosition, 0.3};
    out.drive = vehicle::DriveInput{1, 0.2, false};
    remark("harder than it looks");
    if (phase_time() < 0.5) return false;
    return step_.end == StepState::kDone || fall_short(step_.end, "it did not work");
  }
  const Trying& step_;
};

std::unique_ptr<Activity> Trying::activity(OperatorContext& place) const {
  return std::make_unique<TryingHard>(place, *this);
}

scene::Program program(StepState end) {
  Trying trying;
  trying.end = end;
  return {{Wait(0.1), trying, Wait(0.1)}, {}};
}

/// An operator on a machine at x = time.
struct Trial {
  explicit Trial(StepState end) : op(ew180_like(), program(end), "digger") {
    seen.joints.resize(4);
  }
  Command step() {
    seen.X_WB.translation().x() = time;
    const Command out = op.update(seen, time, kStep);
    time += kStep;
    return out;
  }
  void run(double until) {
    while (time < until && !op.ended()) last = step();
  }
  Operator op;
  Observation seen;
  Command last;
  double time = 0;
};

TEST(StepState, HasADistinctNamePerState) {
  std::set<std::string> names;
  for (int i = 0; i <= static_cast<int>(StepState::kReplaced); ++i)
    names.insert(name_of(static_cast<StepState>(i)));
  EXPECT_EQ(names.size(), 12u);
  EXPECT_FALSE(fell_short(StepState::kRunning));
  EXPECT_FALSE(fell_short(StepState::kDone));
  EXPECT_TRUE(fell_short(StepState::kBlocked));
}

TEST(Outcome, OfADoneStepHasItsAccountAndTheProgramContinues) {
  Trial trial(StepState::kDone);
  trial.run(5);
  EXPECT_TRUE(trial.op.done());
  ASSERT_EQ(trial.op.reports().size(), 3u);
  const StepReport& report = trial.op.reports()[1];
  EXPECT_EQ(report.step, 2);
  EXPECT_EQ(report.element, "trying");
  EXPECT_EQ(report.state, StepState::kDone);
  EXPECT_EQ(report.reason, "harder than it looks");
  EXPECT_NEAR(report.end - report.start, 0.5, 0.011);
  EXPECT_DOUBLE_EQ(report.place.x(), report.end);
  ASSERT_EQ(report.measurements.size(), 2u);
  EXPECT_EQ(report.measurements[0].name, "way_m");
  EXPECT_DOUBLE_EQ(report.measurements[0].value, report.end);
}

TEST(Outcome, OfAFailedStepEndsTheProgramAndStopsTheMachine) {
  Trial trial(StepState::kBlocked);
  trial.run(5);
  EXPECT_TRUE(trial.op.ended());
  EXPECT_FALSE(trial.op.done());
  EXPECT_EQ(trial.op.phase(), "blocked");
  EXPECT_TRUE(trial.op.progress().failed);
  EXPECT_EQ(trial.op.progress().done, 1);
  // The joint that the program moved stops, the others keep their commands; the drive brakes with
  // its steering unchanged.
  ASSERT_TRUE(trial.last.joints[1].has_value());
  EXPECT_EQ(trial.last.joints[1]->mode, vehicle::JointMode::kVelocity);
  EXPECT_EQ(trial.last.joints[1]->target, 0);
  EXPECT_FALSE(trial.last.joints[0].has_value());
  ASSERT_TRUE(trial.last.drive.has_value());
  EXPECT_TRUE(trial.last.drive->brake);
  EXPECT_EQ(trial.last.drive->steer, 0.2);
  ASSERT_EQ(trial.op.reports().size(), 2u);
  EXPECT_EQ(trial.op.reports()[1].reason, "it did not work");
  EXPECT_EQ(trial.op.reports()[1].measurements.size(), 2u);
  // No further command follows.
  const Command after = trial.step();
  EXPECT_FALSE(after.drive.has_value());
  for (const auto& joint : after.joints) EXPECT_FALSE(joint.has_value());
}

TEST(Outcome, OfARunningStepIsReportedWithoutSideEffects) {
  Trial trial(StepState::kDone);
  trial.run(0.4);
  const std::uint64_t before = hash_of(trial.op).digest();
  const StepReport present = trial.op.present(trial.seen, trial.time);
  EXPECT_EQ(present.step, 2);
  EXPECT_EQ(present.state, StepState::kRunning);
  EXPECT_EQ(present.measurements.size(), 2u);
  EXPECT_EQ(hash_of(trial.op).digest(), before);
}

/// Returns the outcome of a program of one long wait while the machine stands like this for `time`
/// [s].
StepReport standing(const vehicle::Stability& stands, double time, double wheels_under = 0) {
  Operator op(ew180_like(), {{Wait(100)}, {}});
  Observation seen;
  seen.joints.resize(4);
  seen.stability = stands;
  seen.wheels_under = wheels_under;
  double t = 0;
  for (; t < time && !op.ended(); t += kStep) op.update(seen, t, kStep);
  return op.present(seen, t);
}

TEST(Watch, EndsAProgramWhoseMachineTipsOver) {
  const StepReport past = standing({true, radians(50), 0, 0.3}, 1);
  EXPECT_EQ(past.state, StepState::kTipped);
  EXPECT_EQ(past.reason, "it tilts by 50.00 deg");
  EXPECT_EQ(past.end, 0);
  const StepReport over = standing({true, radians(31), 0.3, -0.12}, 1);
  EXPECT_EQ(over.state, StepState::kTipped);
  EXPECT_EQ(over.reason,
            "its centre of mass is 0.12 m outside its support polygon and it tilts by 31.00 deg");
  EXPECT_NEAR(over.end, 0.2, 2 * kStep);
}

TEST(Watch, ReportsAMachineThatTipsOverAfterItsProgram) {
  Trial trial(StepState::kDone);
  trial.run(5);
  ASSERT_TRUE(trial.op.done());
  for (int i = 0; i < 100; ++i) trial.step();
  ASSERT_TRUE(trial.op.done()) << "an idle machine there is no fault";
  trial.seen.stability = {true, radians(50), 0, 0.3};
  const Command last = trial.step();
  EXPECT_FALSE(trial.op.done());
  EXPECT_TRUE(trial.op.ended());
  EXPECT_EQ(trial.op.phase(), "tipped");
  ASSERT_EQ(trial.op.reports().size(), 4u);
  EXPECT_EQ(trial.op.reports()[2].state, StepState::kDone);
  const StepReport& report = trial.op.reports()[3];
  EXPECT_EQ(report.step, 3);
  EXPECT_EQ(report.state, StepState::kTipped);
  EXPECT_EQ(report.reason, "after its program was done: it tilts by 50.00 deg");
  EXPECT_GT(report.end, 1.5);
  // The joint that the program had moved stops.
  ASSERT_TRUE(last.joints[1].has_value());
  EXPECT_EQ(last.joints[1]->mode, vehicle::JointMode::kVelocity);
  // The report survives a snapshot and is issued once.
  Trial resumed(StepState::kDone);
  load_saved(saved(trial.op), resumed.op);
  EXPECT_EQ(hash_of(resumed.op).digest(), hash_of(trial.op).digest());
  trial.step();
  EXPECT_EQ(trial.op.reports().size(), 4u);
}

TEST(Watch, IgnoresAMachineThatRecoversOrCannotTip) {
  EXPECT_EQ(standing({true, radians(44), 1, 0.01}, 1).state, StepState::kRunning)
      << "steep, but within its supports";
  EXPECT_EQ(standing({true, radians(31), -0.3, -0.1}, 1).state, StepState::kRunning)
      << "it falls back";
  EXPECT_EQ(standing({true, radians(31), 0.3, -0.1}, 0.1).state, StepState::kRunning)
      << "briefly on a stone";
  EXPECT_EQ(standing({false, radians(90), 1, -1}, 1).state, StepState::kRunning)
      << "kinematic or held";
}

TEST(Watch, EndsAProgramWhoseMachineIsBuried) {
  EXPECT_EQ(standing({true, 0, 0, 1}, 1, 0.25).state, StepState::kRunning);
  EXPECT_EQ(standing({true, 0, 0, 1}, 1, 0.5).state, StepState::kBuried);
}

TEST(Outcome, SavesAndHashesEveryByte) {
  for (const double time : {0.05, 0.4, 5.0}) {
    Trial whole(StepState::kTipped), resumed(StepState::kTipped);
    whole.run(time);
    load_saved(saved(whole.op), resumed.op);
    EXPECT_EQ(hash_of(resumed.op).digest(), hash_of(whole.op).digest());
    EXPECT_EQ(resumed.op.phase(), whole.op.phase());
    EXPECT_EQ(resumed.op.reports().size(), whole.op.reports().size());
    EXPECT_EQ(test::flip_every_byte(whole.op, resumed.op), "") << time;
  }
}

}  // namespace
}  // namespace navvy::control::testing
