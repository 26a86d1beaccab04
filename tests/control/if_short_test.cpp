// SPDX-License-Identifier: Apache-2.0
// Programs that go on after a step that fell short.
#include "control/activities/if_short.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "control/activities/repeat.h"
#include "control/activities/wait.h"
#include "control/activities/wait_for.h"
#include "control/ew180_like.h"
#include "control/operator.h"
#include "control/reach.h"
#include "core/saved_state.h"
#include "log_lines.h"

namespace navvy::control::testing {
namespace {

constexpr double kStep = 0.01;  // [s]

IfShort if_short(int steps) {
  IfShort out;
  out.steps = steps;
  return out;
}

/// A truck that never comes: the step falls short after 0.05 s.
WaitFor truck() { return WaitFor("truck", 0, 0.05); }

/// A program on a machine that does nothing else.
struct Doer {
  explicit Doer(std::vector<scene::ProgramStep> steps)
      : machine(ew180_like()), op(machine, scene::Program{std::move(steps), {}}) {
    seen.joints.resize(machine.joints.size());
    programs["truck"] = {0, 3};
    seen.programs = &programs;
  }
  void step() { op.update(seen, time += kStep, kStep); }
  void finish() {
    while (!op.ended() && time < 10) step();
  }
  std::vector<std::string> elements() const {
    std::vector<std::string> out;
    for (const StepReport& one : op.reports()) out.push_back(one.element);
    return out;
  }
  const LogLines log;
  scene::Machine machine;
  Operator op;
  Observation seen;
  std::map<std::string, ProgramProgress> programs;
  double time = 0;
};

TEST(IfShort, RunsItsStepsOnlyAfterAFailure) {
  Doer fails({truck(), Wait(0.02), if_short(1), Wait(0.03), Wait(0.04)});
  fails.finish();
  EXPECT_TRUE(fails.op.done());
  // The step between the failure and the if_short is left out.
  EXPECT_EQ(fails.elements(), (std::vector<std::string>{"wait_for", "if_short", "wait", "wait"}));
  EXPECT_EQ(fails.op.reports()[0].state, StepState::kOutOfTime);
  EXPECT_EQ(fails.op.reports()[2].step, 4);
  EXPECT_NE(fails.log.text().find("the program goes on at step 3"), std::string::npos)
      << fails.log.text();

  Doer works({Wait(0.02), if_short(1), Wait(0.03), Wait(0.04)});
  works.finish();
  EXPECT_TRUE(works.op.done());
  EXPECT_EQ(works.elements(), (std::vector<std::string>{"wait", "if_short", "wait"}));
  EXPECT_EQ(works.op.reports()[2].step, 4);
}

TEST(IfShort, EndsARepeatWhenNoTruckComes) {
  Repeat always;
  always.steps = 2;
  always.times = 1000;
  Doer run({truck(), Wait(0.02), always, if_short(0), Wait(0.02)});
  run.programs["truck"] = {3, 3};
  while (run.op.reports().size() < 7) run.step();
  run.programs["truck"] = {0, 3};
  run.finish();
  EXPECT_TRUE(run.op.done());
  EXPECT_EQ(run.op.reports().back().element, "wait");
  EXPECT_EQ(run.op.reports().back().step, 5);
}

TEST(IfShort, DoesNotHelpBeforeTheFailure) {
  Doer run({Wait(0.02), if_short(0), truck(), Wait(0.02)});
  run.finish();
  EXPECT_FALSE(run.op.done());
  EXPECT_EQ(run.op.phase(), "out_of_time");
}

TEST(IfShort, LetsNoMachineGoOnThatIsOffTheSite) {
  Doer run({Wait(5), if_short(0), Wait(0.02)});
  const heightfield::Ground ground = [] {
    heightfield::Ground::Setup setup;
    setup.nx = setup.ny = 40;
    setup.cell = 0.1;
    setup.soils = {scene::Soil()};
    setup.layers = {{setup.soils[0].name, 1}};
    setup.surface = [](int, int) { return 0.0; };
    return heightfield::Ground(std::move(setup));
  }();
  run.seen.ground = &ground;
  run.seen.X_WB = make_pose(9, 0, 0);
  run.finish();
  EXPECT_FALSE(run.op.done());
  EXPECT_EQ(run.op.phase(), "off_site");
}

TEST(IfShort, ResumesBetweenTheFailureAndItsCatch) {
  Doer whole({truck(), if_short(1), Wait(0.05), Wait(0.05)}),
      resumed({truck(), if_short(1), Wait(0.05), Wait(0.05)});
  while (whole.op.reports().empty()) whole.step();
  load_saved(saved(whole.op), resumed.op);
  resumed.time = whole.time;
  whole.finish();
  resumed.finish();
  EXPECT_EQ(resumed.elements(), whole.elements());
  EXPECT_EQ(hash_of(resumed.op).digest(), hash_of(whole.op).digest());
}

}  // namespace
}  // namespace navvy::control::testing
