// SPDX-License-Identifier: Apache-2.0
// Lanes of a roller, and their drives.
#include "control/activities/compact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/dig_rig.h"
#include "control/simple_planners.h"
#include "core/saved_state.h"
#include "log_lines.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "vehicle/collision_box.h"

namespace navvy::control::testing {
namespace {

/// Returns a machine with wheels.
const scene::Machine& roller() {
  static const scene::Machine machine =
      scene_io::load_machine(std::string(navvy::source_dir()) + "/vehicles/ew180/model.sdf");
  return machine;
}

std::vector<Vec2> rectangle(double length, double width) {
  const double a = 0.5 * length, b = 0.5 * width;
  return {{-a, -b}, {a, -b}, {a, b}, {-a, b}};
}

/// Returns the greatest distance between a place across the area and the next wheel track [m].
double worst_gap(const std::vector<RollerLane>& lanes, double width) {
  const scene::Machine& machine = roller();
  double out = 0;
  for (double y = -0.5 * width; y <= 0.5 * width; y += 0.01) {
    double gap = 10;
    for (const RollerLane& lane : lanes)
      for (const scene::Wheel& wheel : machine.wheels) {
        const std::optional<vehicle::WheelBox> around = vehicle::box_of(machine, wheel);
        const Pose X_BO =
            machine.links[0].X_ML.inverse() * machine.links[around->link].X_ML * around->box.X_WO;
        const double half = (X_BO.linear().cwiseAbs() * around->box.half).y();
        gap = std::min(
            gap, std::max(0.0, std::abs(y - lane.from.p.y() - X_BO.translation().y()) - half));
      }
    out = std::max(out, gap);
  }
  return out;
}

TEST(RollerLanes, CoverAnyWidthWithTheTracksOfTheWheels) {
  for (const double width : {0.3, 1.05, 2.0, 5.0}) {
    const std::vector<RollerLane> lanes = roller_lanes(roller(), rectangle(8, width), 0.2);
    EXPECT_LE(worst_gap(lanes, width), 0.01) << width;
    EXPECT_LE(lanes.size(), 2 + static_cast<std::size_t>(width / 0.4)) << width;
    for (const RollerLane& one : lanes) {
      EXPECT_EQ(one.from.yaw, 0);
      EXPECT_LT(one.from.p.x(), -4);
      EXPECT_GT(one.to.p.x(), 4);
    }
  }
}

TEST(RollerLanes, LieInTheDirectionThatTheMachineFaces) {
  const std::vector<RollerLane> lanes = roller_lanes(roller(), rectangle(8, 1), radians(170));
  ASSERT_FALSE(lanes.empty());
  EXPECT_NEAR(std::abs(lanes[0].from.yaw), kPi, 1e-9);
  EXPECT_GT(lanes[0].from.p.x(), 4);
}

/// Returns a machine at the beginning of the first lane, turned by `yaw` [rad].
DigRig rig_of(const Compact& step, double yaw = 0) {
  scene::Program program;
  program.steps = {step};
  const PlanePose at = roller_lanes(roller(), step.polygon, 0).front().from;
  return {roller(),
          program,
          make_pose(at.p.x(), at.p.y(), 0, 0, 0, yaw),
          {[](const scene::Machine&) { return std::make_unique<BlockedPlanner>(); }, {}}};
}

double value(const StepReport& report, const std::string& name) {
  for (const Measurement& one : report.measurements)
    if (one.name == name) return one.value;
  ADD_FAILURE() << name;
  return 0;
}

TEST(Compact, DrivesEachLaneToAndFro) {
  const LogLines log;
  Compact step;
  step.polygon = rectangle(4, 0.3);
  step.passes = 3;
  DigRig rig = rig_of(step);
  ASSERT_TRUE(rig.run(300)) << log.text();
  const PlanePose end = roller_lanes(roller(), step.polygon, 0).front().to;
  const StepReport& report = rig.op.reports().back();
  EXPECT_NEAR(report.place.x(), end.p.x(), 0.4);  // the step's own tolerance
  EXPECT_EQ(value(report, "lanes"), 1);
  EXPECT_EQ(value(report, "lanes_missed"), 0);
  EXPECT_GT(value(report, "density_kg_m3"), 1000);
}

TEST(Compact, DrivesToTheOtherEndOfALaneThatLiesAside) {
  const LogLines log;
  Compact step;
  step.polygon = rectangle(4, 1.05);
  step.passes = 2;
  DigRig rig = rig_of(step);
  ASSERT_TRUE(rig.run(300)) << log.text();
  EXPECT_EQ(value(rig.op.reports().back(), "lanes"), 2);
}

TEST(Compact, LeavesOutLanesThatItCannotReach) {
  const LogLines log;
  Compact step;
  step.polygon = rectangle(4, 1.05);
  step.passes = 2;
  // Straight ahead lies no lane, and the planner finds no path.
  DigRig rig = rig_of(step, radians(40));
  EXPECT_FALSE(rig.run(300));
  const StepReport& report = rig.op.reports().back();
  EXPECT_EQ(report.state, StepState::kBlocked);
  EXPECT_NE(report.reason.find("2 of 2 lanes could not be driven"), std::string::npos)
      << report.reason;
  EXPECT_NE(log.text().find("lane 2 of 2 is left out"), std::string::npos) << log.text();
}

TEST(Compact, ResumesBitIdenticallyOnALane) {
  Compact step;
  step.polygon = rectangle(4, 0.3);
  DigRig whole = rig_of(step), resumed = rig_of(step);
  while (whole.time < 15) whole.step();
  load_saved(saved(whole), resumed);
  for (int i = 0; i < 4000; ++i) {
    whole.step();
    resumed.step();
  }
  EXPECT_EQ(resumed.digest(), whole.digest());
}

}  // namespace
}  // namespace navvy::control::testing
