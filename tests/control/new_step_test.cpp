// SPDX-License-Identifier: Apache-2.0
// A new program step needs only its class and a row of the table: this file adds one without
// touching others.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "control/activities/wait.h"
#include "control/activity_step.h"
#include "control/arm_move.h"
#include "control/dig_rig.h"
#include "control/operator.h"
#include "control/reach.h"
#include "control/step_kinds.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "paths.h"
#include "scene_io/loader.h"

namespace navvy::control::testing {
namespace {

constexpr double kStep = 0.01;  // [s]

/// Nods with the boom a number of times, after another machine has finished its program if one is
/// named.
struct Nod final : ActivityStep {
  static constexpr const char* kElement = "salute";
  static constexpr const char* kText = "Nods with the boom.";
  int times = 1;
  std::string after;

  void describe(scene::Fields& f) override {
    f("times", times, {1, 10}, "Number of nods.", scene::kNeeded);
    f("after", after, "Machine to wait for.");
  }
  void check(const scene::StepSource& source) const {
    source.require(source.machine && !source.machine->arm.boom.empty(),
                   "salute needs a machine with a boom");
  }
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  std::optional<scene::Waiting> waits_for() const override {
    return after.empty() ? std::nullopt : std::optional<scene::Waiting>({after, 0});
  }
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override {
    if (times > 5)
      check.fault("salute/times", std::to_string(times), "a machine nods at most five times",
                  "nod less");
  }
};

struct NodMemory {
  ArmMove move;
  std::int64_t left = 0;  // strokes, two per nod
  double high = 0;        // [rad]

  void visit(Archive& a) {
    a("move", move);
    a("left", left);
    a("high", high);
  }
};

class Nodding final : public ActivityWith<NodMemory> {
 public:
  Nodding(OperatorContext& place, const Nod& step) : ActivityWith(place), step_(step) {}
  const char* phase() const override { return m.left % 2 == 0 ? "down" : "up"; }
  void begin(const Observation& seen) override {
    m.left = 2 * step_.times;
    m.high = place_.handover.q[1];
    stroke(seen);
  }

 private:
  void stroke(const Observation& seen) {
    Axes to = place_.handover.q;
    to[1] = m.left % 2 == 0 ? m.high - 0.1 : m.high;
    m.move.start(place_, to, seen, {});
  }
  bool update(const Observation& seen, double, Command&) override {
    if (!m.move.advance(place_, seen, phase_time(), phase())) return false;
    if (--m.left == 0) return true;
    stroke(seen);
    enter(0);
    return false;
  }
  const Nod& step_;
};

std::unique_ptr<Activity> Nod::activity(OperatorContext& place) const {
  return std::make_unique<Nodding>(place, *this);
}

scene::StepKinds kinds_with_nod() {
  scene::StepKinds kinds = step_kinds();
  kinds.push_back(scene::step_kind<Nod>());
  return kinds;
}

/// Returns a scene with two excavators that run these programs.
scene::Scene load(const std::string& first, const std::string& second,
                  const scene::StepKinds& kinds) {
  const auto machine = [](const char* name, const char* x, const std::string& program) {
    return "<include><uri>model://ew180</uri><name>" + std::string(name) + "</name><pose>" + x +
           " 0 0 0 0 0</pose>" + "<navvy:program>\n" + program + "\n</navvy:program></include>\n";
  };
  const std::string text =
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil ref=\"loam\"/>" +
      std::string("<navvy:ground><size_m>60 20</size_m></navvy:ground>\n") +
      machine("first", "-15", first) + machine("second", "15", second) + "</world></sdf>";
  return scene_io::load_scene_from_string(text, navvy::source_dir() + "/scenarios/mine.sdf", kinds);
}

std::string failure(const std::string& first, const std::string& second,
                    const scene::StepKinds& kinds) {
  try {
    load(first, second, kinds);
  } catch (const InputError& error) {
    return error.what();
  }
  return "loaded";
}

void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
}

const char* const kWait = "<wait><duration_s>1</duration_s></wait>";

/// An operator on a machine that follows its commands at once.
struct Trial {
  explicit Trial(const scene::MachineInWorld& placed) : op(placed.machine, placed.program) {
    for (const scene::Joint& joint : placed.machine.joints) {
      seen.joints.emplace_back();
      seen.joints.back().position = joint.initial;
      seen.joints.back().velocity_limit = joint.velocity;
    }
    boom = static_cast<std::size_t>(placed.machine.joint_index(placed.machine.arm.boom));
  }
  void step() {
    const Command command = op.update(seen, 0, kStep);
    for (std::size_t j = 0; j < command.joints.size(); ++j)
      if (command.joints[j]) seen.joints[j].position = command.joints[j]->target;
  }
  std::uint64_t digest() const { return hash_of(op).digest(); }
  Operator op;
  Observation seen;
  std::size_t boom = 0;
};

TEST(NewStep, IsReadAndRunsAfterOthersAndBeforeOthers) {
  const scene::Scene world = load(std::string(kWait) + "<salute><times>2</times></salute>" + kWait,
                                  kWait, kinds_with_nod());
  const scene::MachineInWorld& placed = world.machines[0];
  ASSERT_EQ(placed.program.steps.size(), 3u);
  ASSERT_NE(placed.program.steps[1].as<Nod>(), nullptr);
  Trial trial(placed);
  const double high = trial.seen.joints[trial.boom].position;
  double lowest = high;
  int turns = 0;
  std::string before = trial.op.phase();
  for (int i = 0; i < 5000 && !trial.op.done(); ++i) {
    trial.step();
    lowest = std::min(lowest, trial.seen.joints[trial.boom].position);
    const std::string now = trial.op.phase();
    turns += now != before && (now == "up" || now == "down");
    before = now;
  }
  EXPECT_TRUE(trial.op.done());
  EXPECT_EQ(turns, 4);
  EXPECT_NEAR(lowest, high - 0.1, 1e-9);  // the machine of this test follows at once
  EXPECT_NEAR(trial.seen.joints[trial.boom].position, high, 1e-9);
}

TEST(NewStep, ResumesBitIdenticallyFromASnapshot) {
  const scene::Scene world = load("<salute><times>2</times></salute>", kWait, kinds_with_nod());
  Trial whole(world.machines[0]), resumed(world.machines[0]);
  while (whole.op.phase() != "up") whole.step();
  const std::vector<char> bytes = saved(whole.op);
  load_saved(bytes, resumed.op);
  resumed.seen = whole.seen;
  EXPECT_EQ(resumed.op.phase(), "up");
  for (int i = 0; i < 5000 && !whole.op.done(); ++i) {
    EXPECT_EQ(resumed.digest(), whole.digest());
    whole.step();
    resumed.step();
  }
  EXPECT_TRUE(resumed.op.done());
}

TEST(NewStep, ReportsItsFaultsWithLineAndElement) {
  const std::string text =
      failure(std::string(kWait) + "\n<salute><times>20</times></salute>", kWait, kinds_with_nod());
  expect_in("mine.sdf:4", text);
  expect_in("navvy:program/salute/times", text);
  expect_in("must be a number from 1 to 10", text);
  expect_in("needs an element <times>", failure("<salute/>", kWait, kinds_with_nod()));
}

TEST(NewStep, IsCheckedForItsReach) {
  const scene::Scene world =
      load(std::string(kWait) + "<salute><times>7</times></salute>", kWait, kinds_with_nod());
  const scene::MachineInWorld& placed = world.machines[0];
  const heightfield::Ground ground = flat_ground();
  const std::vector<Fault> faults = check_reach(placed.machine, placed.program, Pose::Identity(),
                                                GroundSurfaceView(ground), "mine.sdf");
  ASSERT_EQ(faults.size(), 1u);
  expect_in("step 2/salute/times", faults[0].text());
}

TEST(NewStep, CanWaitForOtherProgramsAndCyclesAreDetected) {
  const std::string second = "<wait_for><machine>first</machine></wait_for>";
  const std::string first = "<salute><times>1</times><after>second</after></salute>";
  expect_in("the machines wait for each other", failure(first, second, kinds_with_nod()));
  expect_in(
      "no machine of this name",
      failure("<salute><times>1</times><after>nobody</after></salute>", kWait, kinds_with_nod()));
}

TEST(NewStep, IsUnknownWithoutItsRow) {
  expect_in("known here: drive_to, dig, swing, dump, wait, tip, wait_for, trajectory, go_to",
            failure("<salute><times>2</times></salute>", kWait, step_kinds()));
  expect_in("did you mean 'salute'?",
            failure("<salutee><times>2</times></salutee>", kWait, kinds_with_nod()));
}

TEST(NewStep, MustBeAStepOfTheOperator) {
  struct Foreign final : scene::Step {
    const char* element() const override { return "foreign"; }
    void describe(scene::Fields&) override {}
  };
  const scene::Scene world = load(kWait, kWait, step_kinds());
  EXPECT_THROW(Operator(world.machines[0].machine, {{Foreign{}}, {}}), InputError);
}

}  // namespace
}  // namespace navvy::control::testing
