// SPDX-License-Identifier: Apache-2.0
// Stones taken out of an area in a closed loop, and the faults that show before a run; geometry
// only.
#include "control/activities/dig/clear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "control/activities/dig/clear_strip.h"
#include "control/arm_kinematics.h"
#include "control/dig_pose.h"
#include "control/dig_rig.h"
#include "control/ew180_like.h"
#include "control/operator.h"
#include "control/reach.h"
#include "core/saved_state.h"
#include "flip_bytes.h"
#include "log_lines.h"

namespace navvy::control::testing {
namespace {

/// An area ahead of a machine at (-4, 0), whose swing axis is at (-2.75, 0).
Clear clear_ahead() {
  Clear step;
  step.polygon = {Vec2(1, -2), Vec2(5, -2), Vec2(5, 2), Vec2(1, 2)};
  step.dump_at = Vec2(-1.7, 5.9);
  return step;
}

BodyView stone(const std::string& name, double x, double y, double size) {
  return {name, Vec3(x, y, 0.5 * size), size, size, 2600 * size * size * size, 0, true};
}

DigRig rig_of(const Clear& step, const std::vector<BodyView>& bodies) {
  DigRig out{ew180_like(), {{step}, {}}, make_pose(-4, 0, 0)};
  for (const BodyView& body : bodies) out.stones.push_back({body, false, false, Vec3::Zero()});
  return out;
}

std::vector<BodyView> three() {
  return {stone("far", 4, -0.6, 0.6), stone("near", 2, 1, 0.3), stone("middle", 3, 0.1, 0.5)};
}

double value_of(const StepReport& step, const std::string& name) {
  for (const Measurement& one : step.measurements)
    if (one.name == name) return one.value;
  ADD_FAILURE() << "no value " << name;
  return std::nan("");
}

void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
}

TEST(Clear, TakesEveryBodyToThePlaceTheNearestThatIsFreeFirst) {
  DigRig rig = rig_of(clear_ahead(), three());
  std::vector<std::string> order;
  while (!rig.op.ended() && rig.time < 300) {
    rig.step();
    for (const DigRig::Stone& one : rig.stones)
      if (one.held && (order.empty() || order.back() != one.body.name))
        order.push_back(one.body.name);
  }
  ASSERT_TRUE(rig.op.done()) << rig.op.reports().at(0).reason;
  // The bucket would go down on the far one behind the middle one.
  EXPECT_EQ(order, (std::vector<std::string>{"near", "far", "middle"}));
  for (const DigRig::Stone& one : rig.stones)
    EXPECT_LT((one.body.centre.head<2>() - clear_ahead().dump_at).norm(), 1) << one.body.name;
  const StepReport& report = rig.op.reports().at(0);
  EXPECT_EQ(value_of(report, "bodies"), 3);
  EXPECT_EQ(value_of(report, "cleared"), 3);
  EXPECT_EQ(value_of(report, "left"), 0);
  EXPECT_EQ(value_of(report, "tries"), 3);
  EXPECT_LT(value_of(report, "farthest_m"), 1);
}

TEST(Clear, LeavesABodyThatDoesNotStayInTheBucketAfterItsTriesAndSaysWhere) {
  const LogLines log;
  Clear step = clear_ahead();
  step.tries = 2;
  DigRig rig = rig_of(step, three());
  rig.stones[2].slips = true;
  EXPECT_FALSE(rig.run(300));
  const StepReport& report = rig.op.reports().at(0);
  EXPECT_EQ(report.state, StepState::kBlocked);
  expect_in(
      "1 of 3 bodies left: 'middle' at (3.00 , 0.10 ) after 2 tries, the bucket did not take it up",
      report.reason);
  EXPECT_EQ(value_of(report, "cleared"), 2);
  EXPECT_EQ(value_of(report, "left"), 1);
  EXPECT_EQ(value_of(report, "tries"), 4);
}

TEST(Clear, IgnoresBodiesOutsideAndIsDoneInAnEmptyArea) {
  DigRig rig = rig_of(clear_ahead(), {stone("aside", 3, 4, 0.4)});
  EXPECT_TRUE(rig.run(10));
  EXPECT_EQ(rig.op.reports().at(0).reason, "no loose body was in the polygon");
  EXPECT_EQ(value_of(rig.op.reports().at(0), "bodies"), 0);
}

TEST(Clear, LeavesABodyThatIsOutOfReach) {
  Clear step = clear_ahead();
  step.polygon[1].x() = step.polygon[2].x() = 9;
  DigRig rig = rig_of(step, {stone("far", 8, 0, 0.4)});
  EXPECT_FALSE(rig.run(10));
  EXPECT_EQ(rig.op.reports().at(0).state, StepState::kBlocked);
  expect_in(
      "'far' at (8.00 , 0.00 ) after 0 tries, 10.75 m from the swing axis, it is out of reach",
      rig.op.reports().at(0).reason);
}

TEST(Clear, ResumesBitIdenticallyFromASnapshotInAScoopAndBetweenTwo) {
  for (const char* phase : {"drag", "dump", "look"}) {
    DigRig whole = rig_of(clear_ahead(), three()), resumed = rig_of(clear_ahead(), three());
    while (whole.time < 100 && whole.op.phase() != phase) whole.step();
    ASSERT_EQ(whole.op.phase(), phase);
    load_saved(saved(whole), resumed);
    resumed.stones = whole.stones;
    EXPECT_EQ(resumed.digest(), whole.digest());
    while (!whole.op.ended() && whole.time < 300) {
      whole.step();
      resumed.step();
    }
    EXPECT_TRUE(resumed.op.done());
    EXPECT_EQ(resumed.digest(), whole.digest()) << phase;
  }
}

TEST(Clear, HashesEveryByteTheOperatorSavesInMidScoop) {
  DigRig half = rig_of(clear_ahead(), three()), target = rig_of(clear_ahead(), three());
  while (half.time < 100 && half.op.phase() != "drag") half.step();
  EXPECT_EQ(test::flip_every_byte(half.op, target.op), "");
}

TEST(ClearStrip, BeginsBehindTheBodyAndInFrontOfAnotherOne) {
  const ArmKinematics arm(ew180_like());
  const heightfield::Ground ground = flat_ground();
  const GroundSurfaceView surface(ground);
  const Pose X_WS = make_pose(-4, 0, 0) * arm.X_BS();
  const BodyView body = stone("one", 2.25, 0, 0.4);
  const auto strip = [&](const std::vector<BodyView>& bodies) {
    return clear_strip(arm, X_WS, body, bodies, 0.1, surface);
  };
  const std::optional<ClearStrip> alone = strip({body});
  ASSERT_TRUE(alone);
  EXPECT_GT(alone->far.x(), body.centre.x() + 0.5 * body.largest + 0.3);
  EXPECT_LT(alone->near.x(), body.centre.x() - 0.5 * body.largest);
  // Heights of the ground are whole mass units.
  EXPECT_NEAR(alone->floor[0], -0.1, 1e-6);
  EXPECT_NEAR(alone->rim, 0.4, 1e-6);
  EXPECT_EQ(alone->behind + alone->before, 0);
  // 1 m between both bodies: the bucket goes down there.
  const std::optional<ClearStrip> between = strip({body, stone("behind", 3.6, 0.3, 0.3)});
  ASSERT_TRUE(between);
  EXPECT_LT(between->far.x(), 3.6 - 0.15 - 0.1);
  EXPECT_LT(between->far.x(), alone->far.x());
  EXPECT_EQ(between->behind, 0);
  // No space for it; and a body in front, and one beside.
  const std::optional<ClearStrip> crowded =
      strip({body, stone("behind", 2.9, 0.3, 0.3), stone("before", 1.5, 0.3, 0.3),
             stone("beside", 2.25, 1, 0.3)});
  ASSERT_TRUE(crowded);
  EXPECT_EQ(crowded->behind, 1);
  EXPECT_EQ(crowded->before, 1);
  // Sunk into the ground by 0.2 m: the edge passes below it.
  BodyView sunk = body;
  sunk.centre.z() = 0;
  const std::optional<ClearStrip> deep = clear_strip(arm, X_WS, sunk, {sunk}, 0.1, surface);
  ASSERT_TRUE(deep);
  EXPECT_NEAR(deep->floor[0], -0.23, 1e-6);
}

TEST(ArmKinematics, KnowsWhatIsInTheBucket) {
  const ArmKinematics arm(ew180_like());
  // Level, with the opening up: the pin is outward of the tip, the shell below both.
  EXPECT_TRUE(arm.is_in_bucket(kCarry, Vec2(0.7, -0.3), 0));
  EXPECT_FALSE(arm.is_in_bucket(kCarry, Vec2(0.7, 0.3), 0));
  EXPECT_TRUE(arm.is_in_bucket(kCarry, Vec2(0.7, 0.3), 0.4));
  EXPECT_FALSE(arm.is_in_bucket(kCarry, Vec2(0.7, -0.8), 0.1));
  EXPECT_FALSE(arm.is_in_bucket(kCarry, Vec2(-0.4, -0.3), 0));
  // Open over the dump the same place is beside it.
  EXPECT_FALSE(arm.is_in_bucket(kOpen, Vec2(0.7, -0.3), 0));
}

class ClearCheck : public ::testing::Test {
 protected:
  /// Returns all faults of the steps of a machine at (-4, 0), as one text.
  std::string faults_of(const std::vector<scene::ProgramStep>& steps,
                        const std::vector<BodyView>& bodies) {
    std::string all;
    for (const Fault& fault :
         check_reach(machine, {steps, {}}, make_pose(-4, 0, 0), GroundSurfaceView(ground),
                     "clear.sdf", "", {}, nullptr, bodies))
      all += fault.text() + "\n";
    return all;
  }
  scene::Machine machine = ew180_like();
  heightfield::Ground ground = flat_ground();
};

TEST_F(ClearCheck, AcceptsBodiesWithinReach) { EXPECT_EQ(faults_of({clear_ahead()}, three()), ""); }

TEST_F(ClearCheck, NamesABodyOutOfReachWithBothDistances) {
  Clear step = clear_ahead();
  step.polygon[1].x() = step.polygon[2].x() = 9;
  const std::string far = faults_of({step}, {stone("rock", 8, 0, 0.4)});
  expect_in("clear/polygon", far);
  expect_in("'rock' at (8.00 , 0.00 ): 10.75 m from the swing axis", far);
  expect_in("takes up a body of this size from", far);
  expect_in("stand nearer", far);
  step.polygon[0].x() = step.polygon[3].x() = -1;
  expect_in("stand farther back", faults_of({step}, {stone("rock", -0.5, 0, 0.4)}));
}

TEST_F(ClearCheck, WarnsOfABodyWithoutAShell) {
  BodyView body = stone("rock", 3, 0, 0.4);
  body.has_shell = false;
  const std::string text = faults_of({clear_ahead()}, {body});
  expect_in("warning", text);
  expect_in("'rock' at (3.00 , 0.00 )", text);
  expect_in("sinks through loose soil", text);
  EXPECT_EQ(text.find("error"), std::string::npos) << text;
}

TEST_F(ClearCheck, RefusesABodyThatIsLargerThanTheBucket) {
  const std::string text = faults_of({clear_ahead()}, {stone("boulder", 3, 0, 1.2)});
  expect_in("'boulder' at (3.00 , 0.00 ): 1.20 m large", text);
  expect_in("the bucket takes bodies of at most 0.95 m", text);
}

TEST_F(ClearCheck, RefusesAnAreaAndADumpOutOfReach) {
  Clear step = clear_ahead();
  for (Vec2& corner : step.polygon) corner.x() += 7;
  const std::string area = faults_of({step}, {});
  expect_in("10.75 m from the swing axis", area);
  expect_in("no part of the polygon is between", area);
  step = clear_ahead();
  step.dump_at = Vec2(-2, 9.8);
  expect_in("clear/dump_at", faults_of({step}, three()));
  step = clear_ahead();
  step.dump_height = 6;
  expect_in("clear/dump_height", faults_of({step}, three()));
}

TEST_F(ClearCheck, WarnsOfAnEmptyAreaAndOfBodiesThatAStepBeforeMayMove) {
  const std::string empty = faults_of({clear_ahead()}, {stone("aside", 3, 4, 0.4)});
  expect_in("warning", empty);
  expect_in("no loose body is in the polygon", empty);
  const std::string after = faults_of({trench(), clear_ahead()}, {stone("boulder", 3, 0, 1.2)});
  expect_in("warning", after);
  EXPECT_EQ(after.find("error"), std::string::npos) << after;
}

TEST_F(ClearCheck, AppliesTheLimitsOfTheSwing) {
  machine.joints[0].has_limits = true;
  machine.joints[0].lower = radians(-10);
  machine.joints[0].upper = radians(100);
  expect_in("the swing joint turns from", faults_of({clear_ahead()}, {stone("a", 2, -1.9, 0.4)}));
}

}  // namespace
}  // namespace navvy::control::testing
