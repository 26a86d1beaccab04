// SPDX-License-Identifier: Apache-2.0
// Tests activities one at a time, each on a machine whose joints follow their targets; and the
// parts that they share.
#include "control/activity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "control/activities/drive_to.h"
#include "control/activities/dump.h"
#include "control/activities/go_to.h"
#include "control/activities/repeat.h"
#include "control/activities/swing.h"
#include "control/activities/tip.h"
#include "control/activities/trajectory.h"
#include "control/activities/unhitch.h"
#include "control/activities/wait.h"
#include "control/activities/wait_for.h"
#include "control/activity_step.h"
#include "control/arm_move.h"
#include "control/ew180_like.h"
#include "control/operator.h"
#include "control/profile.h"
#include "control/simple_planners.h"
#include "control/stance.h"
#include "control/step_kinds.h"
#include "control/tip_path.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "flip_bytes.h"

namespace navvy::control::testing {
namespace {

constexpr double kStep = 0.01;  // [s]

/// Returns the excavator of the other tests with a bed on its bucket joint, so that one machine can
/// perform every step.
scene::Machine able_machine() {
  scene::Machine machine = ew180_like();
  machine.beds.push_back({"bucket", "bucket", "bucket_joint", 1, ""});
  return machine;
}

/// The activity of one step, started, with only an operator context and the observed state.
class Alone {
 public:
  explicit Alone(const scene::ProgramStep& step_in) : step(step_in), place(able_machine()) {
    seen.joints.resize(place.machine.joints.size());
    for (std::size_t j = 0; j < seen.joints.size(); ++j) {
      seen.joints[j].position = place.machine.joints[j].initial;
      seen.joints[j].velocity_limit = place.machine.joints[j].velocity;
    }
    programs["other"] = {0, 3};
    seen.programs = &programs;
    if (step_of(step).needs_arm()) place.arm.emplace(place.machine);
    if (step_of(step).needs_planner()) place.planner = std::make_unique<StraightPlanner>();
    for (std::size_t i = 0; place.arm && i < 4; ++i)
      place.handover.q[i] = seen.joints[place.joint(i)].position;
    activity = step_of(step).activity(place);
    activity->begin(seen);
  }

  /// Advances by one control step; then the machine follows.
  bool advance() {
    Command command;
    command.joints.resize(seen.joints.size());
    const bool over = activity->advance(seen, kStep, command);
    time += kStep;
    phases.insert(activity->phase());
    for (std::size_t i = 0; place.arm && i < 4; ++i)
      if (auto& slot = command.joints[place.joint(i)]; !slot)
        slot = vehicle::JointInput{vehicle::JointMode::kPosition, place.handover.q[i]};
    for (std::size_t j = 0; j < command.joints.size(); ++j)
      if (command.joints[j]) follow(j, command.joints[j]->target);
    if (command.drive)
      seen.X_WB.translation().x() += command.drive->brake ? 0 : command.drive->speed * kStep;
    return over;
  }
  /// Runs until the activity ends; returns its duration, or `limit` [s].
  double run(double limit) {
    while (!advance() && time < limit) continue;
    return time;
  }
  /// Moves a joint to its target at once, unless it is blocked or limited in rate.
  void follow(std::size_t j, double target) {
    vehicle::JointState& joint = seen.joints[j];
    const double rest = target - joint.position;
    const double travel =
        place.machine.joints[j].name == slow ? std::clamp(rest, -pace * kStep, pace * kStep) : rest;
    joint.position += travel;
    joint.velocity = place.machine.joints[j].name == slow ? travel / kStep : 0;
  }
  std::uint64_t digest() const {
    StateHash hash;
    add_to_hash(hash, place.handover);
    add_to_hash(hash, *activity);
    return hash.digest();
  }

  const scene::ProgramStep step;
  OperatorContext place;
  Observation seen;
  std::map<std::string, ProgramProgress> programs;
  std::unique_ptr<Activity> activity;
  double time = 0;
  std::set<std::string> phases;
  std::string slow;  // name of a joint that moves by `pace` [rad/s] at most
  double pace = 0;
};

Trajectory path() {
  Trajectory step;
  step.joints = {"boom_joint"};
  step.times = {0, 1, 2};
  step.positions = {{0.7}, {0.6}, {0.9}};
  return step;
}

DriveTo ahead() {
  DriveTo step;
  step.target = Vec2(3, 0);
  return step;
}

/// A step of every kind except the dig, which has its own tests.
GoTo there() {
  GoTo step;
  step.target = Vec2(3, 0);
  return step;
}

Repeat twice() {
  Repeat step;
  step.times = 2;
  return step;
}

/// Repeats two steps once.
Repeat twice_two() {
  Repeat step = twice();
  step.steps = 2;
  return step;
}

std::vector<scene::ProgramStep> one_of_each() {
  return {ahead(), Swing(0.8), Dump(0.5),      Wait(1), Tip(-1, 0.5), WaitFor("other", 0, 2),
          path(),  there(),    Unhitch("tow"), twice()};
}

TEST(Activity, EveryKindOfStepIsTestedHere) {
  std::set<std::string> tried, known;
  for (const scene::ProgramStep& step : one_of_each()) tried.insert(step->element());
  for (const scene::StepKind& kind : step_kinds()) known.insert(kind.element);
  known.erase("dig");        // wants soil: dig_test.cpp
  known.erase("dig_area");   // wants soil and a job planner: tests/earthwork
  known.erase("grade");      // as dig_area
  known.erase("backfill");   // as dig_area
  known.erase("load");       // as dig_area
  known.erase("clear");      // wants bodies: clear_test.cpp
  known.erase("compact");    // drives: compact_test.cpp
  known.erase("if_short");   // concerns whole programs: if_short_test.cpp
  known.erase("wait_load");  // wants a bed that is loaded: truck_test.cpp
  EXPECT_EQ(tried, known);
}

TEST(Activity, EndsByItselfForEveryStepAndNamesItsPhaseAfterTheStep) {
  const std::map<std::string, std::set<std::string>> names = {
      {"drive_to", {"drive"}}, {"go_to", {"plan", "turn", "drive", "stop"}}};
  for (const scene::ProgramStep& step : one_of_each()) {
    Alone alone(step);
    EXPECT_LT(alone.run(60), 20) << step->element();
    const auto name = names.find(step->element());
    EXPECT_EQ(alone.phases,
              name == names.end() ? std::set<std::string>{step->element()} : name->second);
  }
}

TEST(Activity, ResumesBitIdenticallyFromASnapshot) {
  for (const scene::ProgramStep& step : one_of_each()) {
    const double length = Alone(step).run(60);
    Alone whole(step), resumed(step);
    while (whole.time < 0.6 * length) whole.advance();
    const std::vector<char> bytes = saved(*whole.activity);
    resumed.activity = step_of(step).activity(resumed.place);
    load_saved(bytes, *resumed.activity);
    resumed.place.handover = whole.place.handover;
    resumed.seen = whole.seen;
    EXPECT_EQ(resumed.digest(), whole.digest()) << step->element();
    for (bool over = false; !over && whole.time < 60;) {
      over = whole.advance();
      EXPECT_EQ(resumed.advance(), over) << step->element();
      ASSERT_EQ(resumed.digest(), whole.digest()) << step->element() << " at " << whole.time;
    }
  }
}

TEST(Activity, HashesEveryByteItSaves) {
  for (const scene::ProgramStep& step : one_of_each()) {
    const double length = Alone(step).run(60);
    Alone half(step);
    while (half.time < 0.6 * length) half.advance();
    EXPECT_EQ(test::flip_every_byte(*half.activity, *Alone(step).activity), "") << step->element();
  }
}

TEST(Activity, SwingMovesOnlyTheUpperStructure) {
  Alone alone(Swing(0.8));
  const Axes before = alone.place.handover.q;
  alone.run(20);
  EXPECT_DOUBLE_EQ(alone.place.handover.q[0], 0.8);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(alone.place.handover.q[i], before[i]);
}

TEST(Activity, DumpOpensTheBucketHoldsAndCurlsBack) {
  Alone alone(Dump(2));
  const double before = alone.place.handover.q[3];
  double open = before, opened_for = 0;
  while (!alone.advance() && alone.time < 30) {
    const double q = alone.place.handover.q[3];
    if (q > open + 1e-9) opened_for = 0;
    open = std::max(open, q);
    // Level to 1e-9 rad: the smooth profile has reached its end.
    if (q > open - 1e-9) opened_for += kStep;
  }
  EXPECT_GT(open, before + 0.7);
  EXPECT_NEAR(opened_for, 2, 0.1);  // ends of the profile are flat to 1e-9 rad for some steps
  EXPECT_DOUBLE_EQ(alone.place.handover.q[3], before);
}

TEST(Activity, TrajectoryPassesItsEndPoseToTheNextMove) {
  // Without an arm in the context it commands joints only; with one the next move begins at its
  // end.
  Alone alone(path());
  alone.run(10);
  EXPECT_EQ(alone.place.handover.q[1], 0);
  Alone with_an_arm(path());
  with_an_arm.place.arm.emplace(with_an_arm.place.machine);
  with_an_arm.run(10);
  EXPECT_DOUBLE_EQ(with_an_arm.place.handover.q[1], 0.9);
}

TEST(Activity, TrajectoryNamesTheBlockedJoint) {
  Alone alone(path());
  alone.slow = "boom_joint";
  alone.seen.joints[1].stalled = true;
  // Half a second of grace at most: a blocked joint is reported early.
  EXPECT_LT(alone.run(10), 2.5);
  EXPECT_EQ(alone.activity->state(), StepState::kBlocked);
  // From 43 deg, the start, to 0.9 rad.
  EXPECT_EQ(alone.activity->reason(),
            "joint 'boom_joint' stopped 8.57 deg short of its last position, at its effort limit: "
            "something holds it");
}

TEST(Activity, TrajectoryWaitsForAMovingJointUpToATimeout) {
  Alone late(path());
  late.slow = "boom_joint";
  late.pace = 0.1;
  // 0.6 to 0.9 rad at 0.1 rad/s with one second planned: about two seconds late, within 3 deg of
  // the target.
  const double end = late.run(20);
  EXPECT_EQ(late.activity->state(), StepState::kDone) << late.activity->reason();
  EXPECT_GT(end, 2.5);
  EXPECT_LT(end, 5);
  EXPECT_NEAR(late.seen.joints[1].position, 0.9, radians(3));
  Alone never(path());
  never.slow = "boom_joint";
  never.pace = 0.021;  // slightly faster than rest
  EXPECT_NEAR(never.run(20), 2 + 5, 0.1);
  EXPECT_EQ(never.activity->state(), StepState::kBlocked);
}

TEST(Activity, DumpNamesTheBlockedBucket) {
  for (const std::string target : {"open", "closed"}) {
    Alone alone(Dump(1));
    double opened = -kPi;
    for (bool over = false; !over && alone.time < 20;) {
      opened = std::max(opened, alone.seen.joints[3].position);
      // Blocked from the start, or as soon as it has begun to close.
      if (target == "open" || alone.seen.joints[3].position < opened - 0.1)
        alone.slow = "bucket_joint";
      over = alone.advance();
    }
    EXPECT_EQ(alone.activity->state(), StepState::kBlocked) << target;
    EXPECT_NE(alone.activity->reason().find("joint 'bucket_joint' stopped "), std::string::npos)
        << alone.activity->reason();
    EXPECT_NE(alone.activity->reason().find(" short of " + target + ": something holds it"),
              std::string::npos)
        << alone.activity->reason();
  }
}

TEST(Activity, ReportsEachEventOnce) {
  Alone alone(Tip(-1, 0.5));
  EXPECT_EQ(alone.activity->take_event(), CycleEvent::kTipStart);
  EXPECT_EQ(alone.activity->take_event(), CycleEvent::kNone);
  alone.run(20);
  EXPECT_EQ(alone.activity->take_event(), CycleEvent::kTipEnd);
}

TEST(Operator, RefusesASnapshotOfAnotherStep) {
  const scene::Machine machine = able_machine();
  Operator waiting(machine, {{Wait(5)}, {}});
  Observation seen;
  seen.joints.resize(machine.joints.size());
  waiting.update(seen, 0, kStep);
  const std::vector<char> bytes = saved(waiting);
  Operator swinging(machine, {{Swing(1)}, {}});
  try {
    load_saved(bytes, swinging);
    FAIL() << "a swing loaded the state of a wait";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'swing'"), std::string::npos) << error.what();
  }
}

TEST(Operator, RepeatsStepsUntilTheRoundsAreOverAndResumesInARound) {
  const scene::Machine machine = able_machine();
  const scene::Program program{{Wait(0.05), Wait(0.02), twice_two(), Wait(0.05)}, {}};
  Observation seen;
  seen.joints.resize(machine.joints.size());
  Operator whole(machine, program), resumed(machine, program);
  double time = 0;
  // In the second round.
  while (whole.reports().size() < 4) whole.update(seen, time += kStep, kStep);
  EXPECT_EQ(whole.progress().done, 1);
  load_saved(saved(whole), resumed);
  while (!whole.ended()) {
    whole.update(seen, time += kStep, kStep);
    resumed.update(seen, time, kStep);
  }
  std::vector<std::string> kinds;
  for (const StepReport& one : whole.reports()) kinds.push_back(one.element);
  EXPECT_EQ(kinds,
            (std::vector<std::string>{"wait", "wait", "repeat", "wait", "wait", "repeat", "wait"}));
  EXPECT_TRUE(whole.done());
  EXPECT_EQ(hash_of(resumed).digest(), hash_of(whole).digest());
}

TEST(ArmMove, TakesTheTimeOfItsSlowestAxisAndRestsAtBothEnds) {
  Alone alone(Swing(0));
  Axes to = alone.place.handover.q;
  to[0] += 0.8;
  ArmMove move;
  move.start(alone.place, to, alone.seen, {});
  // 0.80 rad/s at the fastest moment, 1.5 times the mean; slightly faster than the joint's own
  // limit of 0.85 x 0.9425 rad/s.
  EXPECT_NEAR(move.duration(), 1.5 * 0.8 / std::min(0.80, 0.85 * 0.9425), 1e-12);
  double fastest = 0, before = alone.place.handover.q[0];
  for (int i = 1; i * kStep < move.duration(); ++i) {
    move.advance(alone.place, alone.seen, i * kStep, "test");
    fastest = std::max(fastest, (alone.place.handover.q[0] - before) / kStep);
    before = alone.place.handover.q[0];
  }
  // A control step off the peak, where the parabola has lost 1e-3.
  EXPECT_NEAR(fastest, 0.80, 0.002);
}

TEST(Stance, FiltersShakingAndDetectsTipping) {
  Stance stance;
  stance.begin(make_pose(1, 2, 0, 0, 0, 0.3));
  const ArmKinematics arm(able_machine());
  EXPECT_EQ(stance.tilt_factor(make_pose(1, 2, 0, 0, 0, 0.3)), 1);
  // One and a half degrees come from the tyres; three mean that the bucket tips the machine.
  EXPECT_EQ(stance.tilt_factor(make_pose(1, 2, 0, 0, radians(1.4), 0.3)), 1);
  EXPECT_EQ(stance.tilt_factor(make_pose(1, 2, 0, 0, radians(3.1), 0.3)), 0);
  const Vec3 still = stance.swing_frame(arm).translation();
  stance.follow(make_pose(1, 2, 0.1, 0, 0, 0.3), 0.25);
  // After one time constant 1 - 1/e of a jump has passed the filter.
  EXPECT_NEAR(stance.swing_frame(arm).translation().z() - still.z(), 0.1 * (1 - std::exp(-1)),
              1e-12);
}

TEST(Stance, SettlesWithItsGroundAndReportsTheTippingDirection) {
  const ArmKinematics arm(able_machine());
  const auto pitched = [](double nose_up_deg) {
    return make_pose(1, 2, 0, 0, -radians(nose_up_deg), 0.3);
  };
  Stance stance;
  stance.begin(pitched(0));
  EXPECT_NEAR(stance.rise(pitched(2), arm, 0), radians(2), 1e-12);
  EXPECT_NEAR(stance.rise(pitched(2), arm, kPi), -radians(2), 1e-12);       // the arm over the rear
  EXPECT_NEAR(stance.rise(pitched(2), arm, 0.5 * kPi), 0, 1e-12);           // to the side
  EXPECT_NEAR(stance.rise(make_pose(0, 0, 1, 0, 0, 2), arm, 0), 0, 1e-12);  // turned and moved only
  // The front wheels have sunk: once settled, this is the new attitude, and only more counts as
  // tipping.
  EXPECT_EQ(stance.tilt_factor(pitched(-4.7)), 0);
  for (int i = 0; i < 500; ++i) stance.follow(pitched(-4.7), kStep);
  EXPECT_EQ(stance.tilt_factor(pitched(-4.7)), 0);
  stance.settle();
  EXPECT_EQ(stance.tilt_factor(pitched(-4.7)), 1);
  // 20 time constants of the smoothing
  EXPECT_NEAR(stance.rise(pitched(-2.7), arm, 0), radians(2), 1e-6);
  EXPECT_EQ(stance.tilt_factor(pitched(-1.6)), 0);
}

/// A tip path at 6.5 m ahead of a machine that stands level.
struct OnPath {
  OnPath() {
    stance.begin(Pose::Identity());
    out.joints.resize(alone.seen.joints.size());
    alone.place.handover.q = tip.start(alone.place, stance, Vec2(6.5, 0), 0.2, -radians(93));
    arrive();
  }
  /// Lets the arm reach its commanded angles: nothing holds it.
  void arrive() {
    for (std::size_t k = 0; k < 4; ++k) joint(k).position = alone.place.handover.q[k];
  }
  /// Returns the observed joint of an axis, 0 to 3.
  vehicle::JointState& joint(std::size_t axis) {
    return alone.seen.joints[alone.place.joint(axis)];
  }
  /// Advances the path by one control step; the arm stays where it is.
  void follow(TipPath::Part part) {
    tip.follow(alone.place, stance, Vec2(6.5, 0), alone.seen, kStep, part, out);
  }

  Alone alone{Swing(0)};
  Stance stance;
  TipPath tip;
  Command out;
};

TEST(TipPath, RisesWhenTheBucketLiftsTheFrontAndNotWhenItPullsItDown) {
  OnPath at;
  const auto follow = [&](double nose_up_deg, double seconds) {
    at.alone.seen.X_WB = make_pose(0, 0, 0, 0, -radians(nose_up_deg), 0);
    for (int i = 0; i * kStep < seconds; ++i) {
      // The arm follows at once: nothing blocks it, the machine itself moves.
      at.arrive();
      at.follow(TipPath::Part::kCurl);
    }
  };
  follow(1.4, 1);
  EXPECT_EQ(at.tip.lift, 0);  // within the tyres' compliance
  follow(-2.9, 1);
  EXPECT_EQ(at.tip.lift, 0);
  follow(2.6, 0.5);
  EXPECT_NEAR(at.tip.lift, 0.25, 0.01);  // 0.5 m/s, one control step of slack
  EXPECT_GT(at.tip.slow, 0);             // the path continues slowly
  EXPECT_LT(at.tip.slow, 0.3);
  follow(0, 1);
  EXPECT_NEAR(at.tip.lift, 0.15, 0.01);  // back at 0.1 m/s
}

TEST(Profile, RampAcceleratesAndBrakesEvenly) {
  const double share = 0.2, h = 1e-4;
  EXPECT_EQ(ramp(-1, share), 0);
  EXPECT_EQ(ramp(2, share), 1);
  for (const double t : {0.05, 0.15, 0.3, 0.5, 0.8, 0.9}) {
    EXPECT_NEAR(ramp(t, share) + ramp(1 - t, share), 1, 1e-12);
    // In the middle 1 / (1 - share) of the mean rate, before that in proportion to the time.
    const double rate = (ramp(t + h, share) - ramp(t - h, share)) / (2 * h);
    EXPECT_NEAR(rate, std::min({t, 1 - t, share}) / share / (1 - share), 1e-3) << t;
  }
}

TEST(TipPath, CommandsTargetsAheadOfAMovingPathByTheServosLag) {
  OnPath at;
  Axes before{};
  for (int i = 0; i < 200; ++i) {
    at.arrive();
    before = at.alone.place.handover.q;
    at.tip.z -= 0.2 * kStep;
    at.follow(TipPath::Part::kDown);
  }
  for (std::size_t k = 1; k < 4; ++k) {
    const double q = at.alone.place.handover.q[k], rate = (q - before[k]) / kStep;
    // 1 / 20 s ahead; rates change slowly along the path, and are smoothed over 0.1 s.
    EXPECT_NEAR(at.out.joints[at.alone.place.joint(k)]->target - q, 0.05 * rate,
                0.004 + 0.1 * 0.05 * std::abs(rate));
    EXPECT_GT(std::abs(rate), 0.01);
  }
}

TEST(TipPath, RisesWhileTheTipIsBlockedAndLowersWhenFree) {
  OnPath at;
  // The path goes down half a metre while the joints stay, blocked by soil.
  at.tip.z = -0.3;
  for (int i = 0; i < 200; ++i) at.follow(TipPath::Part::kDown);
  EXPECT_LT(at.tip.slow, 0.35);  // below this a tip at rest counts as blocked
  // 0.3 m/s for the rest of 2 s after the lag has grown and been detected
  EXPECT_GT(at.tip.lift, 0.2);
  const double raised = at.tip.lift;
  // Released: the joints follow at once.
  for (int i = 0; i < 50; ++i) {
    at.arrive();
    at.follow(TipPath::Part::kDown);
  }
  EXPECT_NEAR(at.tip.lift, raised - 0.1 * 0.5, 0.01);  // 0.1 m/s; blocked for a step or two before
}

TEST(TipPath, KeepsTheEdgeOnItsFloorWhenTheMachinePitches) {
  for (const TipPath::Part part : {TipPath::Part::kDown, TipPath::Part::kAlong}) {
    OnPath at;
    // The nose sinks by 0.3 deg, which the stance has not seen yet.
    at.alone.seen.X_WB = make_pose(0, 0, 0, 0, radians(0.3), 0);
    double height = 0;
    for (int i = 0; i < 200; ++i) {
      ArmAngles q;
      at.arrive();
      for (std::size_t k = 0; k < 3; ++k) q[k] = at.alone.place.handover.q[k + 1];
      const BucketPose pose = at.alone.place.arm->forward(q);
      height =
          (at.alone.seen.X_WB * at.alone.place.arm->X_BS() * Vec3(pose.reach, 0, pose.height)).z();
      at.follow(part);
    }
    // 6.5 m x 0.3 deg = 34 mm too low without feedback.
    if (part == TipPath::Part::kAlong)
      EXPECT_NEAR(height, 0.2, 0.002);
    else
      EXPECT_NEAR(height, 0.166, 0.002);
  }
}

TEST(TipPath, SlowsDownWhenACylinderTakesNearlyItsWholeForce) {
  OnPath at;
  const auto slow_at = [&](double share) {
    for (std::size_t k = 0; k < 4; ++k) {
      at.joint(k).effort_limit = 1e5;
      at.joint(k).effort = k == 2 ? -share * 1e5 : 0;
    }
    at.arrive();
    at.follow(TipPath::Part::kAlong);
    return at.tip.slow;
  };
  EXPECT_EQ(slow_at(0.7), 1);
  EXPECT_NEAR(slow_at(0.9), 0.5, 1e-9);
  EXPECT_NEAR(slow_at(1), 0.3, 1e-9);
  EXPECT_EQ(at.tip.lift, 0);
  // A tip that hardly moves rises before the joint stalls.
  for (int i = 0; i < 100; ++i) slow_at(0.97);
  EXPECT_GT(at.tip.lift, 0.1);
}

}  // namespace
}  // namespace navvy::control::testing
