// SPDX-License-Identifier: Apache-2.0
// Messages of the check before the run: the target, the required reach, and the available reach.
#include <gtest/gtest.h>

#include "control/activities/drive_to.h"
#include "control/activities/swing.h"
#include "control/dig_rig.h"
#include "control/ew180_like.h"

namespace navvy::control::testing {
namespace {

class Reach : public ::testing::Test {
 protected:
  /// Returns all faults of one step seen from the machine at (-4, 0), as one text.
  std::string faults_of(const scene::ProgramStep& step) {
    scene::Program program;
    program.steps = {step};
    program.lines = {42};
    std::string all;
    for (const Fault& fault :
         check_reach(machine, program, make_pose(-4, 0, 0), GroundSurfaceView(ground), "dig.sdf"))
      all += fault.text() + "\n";
    return all;
  }
  static void expect_in(const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
  }
  scene::Machine machine = ew180_like();
  heightfield::Ground ground = flat_ground();
};

TEST_F(Reach, AcceptsTheShippedTrench) { EXPECT_EQ(faults_of(trench()), ""); }

TEST_F(Reach, NamesFileLineStepAndBothDistancesOfAFarEndTooFar) {
  Dig dig = trench();
  dig.from.x() = 7.5;
  const std::string text = faults_of(dig);
  expect_in("dig.sdf:42", text);
  expect_in("step 1/dig/far end", text);
  expect_in("10.25 m from the swing axis", text);
  expect_in("the bucket's tip reaches from", text);
}

TEST_F(Reach, ReportsATrenchTooDeep) {
  Dig dig = trench();
  dig.depth = 6.5;
  expect_in("dig/far end", faults_of(dig));
}

TEST_F(Reach, ReportsHowToPlaceTheMachineForALineBesideTheSwingAxis) {
  Dig dig = trench();
  dig.from.y() = dig.to.y() = 1;
  const std::string text = faults_of(dig);
  expect_in("1.00 m beside the swing axis", text);
  expect_in("(-4.00 , 1.00 )", text);
  expect_in("heading 0.00 deg", text);
}

TEST_F(Reach, ReportsAnEndUnderTheMachine) {
  Dig dig = trench();
  dig.to.x() = -0.5;
  expect_in("must stay 3.00 m clear", faults_of(dig));
}

TEST_F(Reach, ReportsADumpTooHighAndTooFar) {
  Dig dig = trench();
  dig.dump_height = 6;
  const std::string high = faults_of(dig);
  expect_in("dig/dump_height", high);
  expect_in("6.00 m", high);
  expect_in("opens at most", high);
  dig = trench();
  dig.dump_at = Vec2(-2, 9.8);
  const std::string far = faults_of(dig);
  expect_in("dig/dump_at", far);
  expect_in("can be opened from", far);
}

TEST_F(Reach, ReportsATrenchWiderThanTheBucket) {
  Dig dig = trench();
  dig.width = 1.6;
  expect_in("the bucket cuts 1.05 m", faults_of(dig));
}

TEST_F(Reach, AppliesTheLimitsOfTheSwing) {
  machine.joints[0].has_limits = true;
  machine.joints[0].lower = radians(-40);
  machine.joints[0].upper = radians(40);
  expect_in("turns from -40.00 deg to 40.00 deg", faults_of(Swing{radians(70)}));
  expect_in("dig/dump_at", faults_of(trench()));
  EXPECT_EQ(faults_of(Swing{radians(30)}), "");
}

TEST_F(Reach, ChecksFromThePoseAfterThePrecedingDrive) {
  DriveTo drive;
  drive.target = Vec2(-4, 0);
  drive.has_heading = true;
  scene::Program program;
  program.steps = {drive, trench()};
  EXPECT_TRUE(
      check_reach(machine, program, make_pose(-9, 0, 0), GroundSurfaceView(ground), "").empty());
  // From (-9, 0) the trench is out of reach.
  program.steps = {trench()};
  EXPECT_FALSE(
      check_reach(machine, program, make_pose(-9, 0, 0), GroundSurfaceView(ground), "").empty());
  // A pose that steering cannot reach.
  drive.target = Vec2(-6, 2.5);
  EXPECT_FALSE(
      check_reach(machine, {{drive}, {}}, make_pose(-9, 0, 0), GroundSurfaceView(ground), "")
          .empty());
}

}  // namespace
}  // namespace navvy::control::testing
