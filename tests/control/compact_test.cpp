// SPDX-License-Identifier: Apache-2.0
// Lanes of a roller, and their drives; places of a bucket, and its presses.
#include "control/activities/compact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "control/activities/press_places.h"
#include "control/dig_rig.h"
#include "control/reach.h"
#include "control/simple_planners.h"
#include "core/saved_state.h"
#include "log_lines.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "values.h"
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

/// Distance along and across the arm of a point from the flat bottom at a place [m]; 0 inside it.
double outside(const Vec2& p, const Vec2& place, const Vec2& axis, const FlatBottom& bottom) {
  const Vec2 out = (place - axis).normalized(), across(-out.y(), out.x());
  return Vec2(std::max(0.0, std::abs((p - place).dot(out)) - 0.5 * bottom.length),
              std::max(0.0, std::abs((p - place).dot(across)) - 0.5 * bottom.width))
      .norm();
}

TEST(PressPlaces, CoverAPolygonWithTheFlatBottom) {
  const FlatBottom bottom = flat_bottom(ArmKinematics(roller()));
  print_value("length of the flat bottom [m]", bottom.length, "0.6 to 0.9", "plates of the shell");
  EXPECT_GT(bottom.length, 0.6);
  EXPECT_LT(bottom.length, 0.9);
  EXPECT_EQ(bottom.width, 1.05);
  const Vec2 axis(1.25, 0.3);
  for (const double length : {0.2, 1.0, 2.5})
    for (const double width : {0.4, 1.3, 4.0}) {
      std::vector<Vec2> polygon = rectangle(length, width);
      for (Vec2& p : polygon) p += Vec2(6.5, 1);
      const std::vector<Vec2> places = press_places(polygon, axis, bottom);
      double worst = 0;
      for (double x = -0.5 * length; x <= 0.5 * length; x += 0.05)
        for (double y = -0.5 * width; y <= 0.5 * width; y += 0.05) {
          double least = 10;
          for (const Vec2& place : places)
            least = std::min(least, outside(Vec2(6.5 + x, 1 + y), place, axis, bottom));
          worst = std::max(worst, least);
        }
      // A bottom is straight and a ring is not: at 6 m its corners lack 1 - cos(5 deg) of that.
      EXPECT_LE(worst, 0.04) << length << " x " << width;
      // Not more places than a grid of half of the bottom's length and width.
      EXPECT_LE(static_cast<double>(places.size()),
                (1 + 2 * length / bottom.length) * (1 + 2 * width / bottom.width));
      for (const Vec2& place : places)
        EXPECT_LT((place - Vec2(6.5, 1)).cwiseAbs().x(), 0.5 * length + 0.4);
    }
}

/// Returns a step that presses an area ahead of a machine at the origin.
Compact press_ahead() {
  Compact step;
  step.polygon = rectangle(1, 1.5);
  for (Vec2& p : step.polygon) p += Vec2(6.5, 0);
  step.with = Compact::With::kBucket;
  step.passes = 2;
  return step;
}

/// Returns a machine at the origin that carries out the step.
DigRig press_rig(const Compact& step) { return {roller(), {{step}, {}}, Pose::Identity(), {}}; }

TEST(CompactWithBucket, PressesEachPlaceFromWhereItStands) {
  const LogLines log;
  DigRig rig = press_rig(press_ahead());
  ASSERT_TRUE(rig.run(300)) << log.text();
  const StepReport& report = rig.op.reports().back();
  EXPECT_EQ(report.place.norm(), 0);
  EXPECT_EQ(value(report, "places"), 4);
  EXPECT_EQ(value(report, "places_missed"), 0);
  EXPECT_EQ(value(report, "passes"), 2);
  EXPECT_EQ(value(report, "density_before_kg_m3"), 1540);
  // The arm of a kinematic machine feels nothing: it goes as deep as it may.
  EXPECT_GT(value(report, "settled_m"), 0.2);
}

TEST(CompactWithBucket, StopsAtTheStatedForce) {
  Compact step = press_ahead();
  step.press = 20e3;
  step.has_press = true;
  step.passes = 1;
  DigRig rig = press_rig(step);
  rig.felt = 20e3;
  ASSERT_TRUE(rig.run(300));
  EXPECT_EQ(value(rig.op.reports().back(), "press_n"), 20e3);
  // The force is felt from the start, so each press ends as soon as the bucket is at the ground.
  EXPECT_LT(value(rig.op.reports().back(), "settled_m"), 0.02);
}

TEST(CompactWithBucket, LeavesOutPlacesThatItDoesNotReach) {
  const LogLines log;
  Compact step = press_ahead();
  for (Vec2& p : step.polygon) p.x() += 2;
  DigRig rig = press_rig(step);
  EXPECT_FALSE(rig.run(300));
  const StepReport& report = rig.op.reports().back();
  EXPECT_EQ(report.state, StepState::kBlocked);
  EXPECT_NE(report.reason.find("places could not be pressed"), std::string::npos) << report.reason;
  EXPECT_GT(value(report, "places_missed"), 0);
  EXPECT_NE(log.text().find("is left out: it is out of the bucket's reach"), std::string::npos)
      << log.text();
}

TEST(CompactWithBucket, ResumesBitIdenticallyInEveryPhase) {
  const Compact step = press_ahead();
  DigRig whole = press_rig(step);
  std::set<std::string> seen;
  while (!whole.op.ended()) {
    whole.step();
    if (!seen.insert(whole.op.phase()).second) continue;
    DigRig beside = press_rig(step), resumed = press_rig(step);
    const std::vector<char> bytes = saved(whole);
    load_saved(bytes, beside);
    load_saved(bytes, resumed);
    EXPECT_EQ(resumed.digest(), whole.digest()) << whole.op.phase();
    for (int i = 0; i < 400; ++i) resumed.step();
    for (int i = 0; i < 400; ++i) beside.step();
    EXPECT_EQ(resumed.digest(), beside.digest());
  }
  for (const char* phase : {"approach", "press", "lift", "look"})
    EXPECT_EQ(seen.count(phase), 1u) << phase;
}

/// Returns the faults and warnings of a step before the run as one text.
std::string faults_of(const Compact& step) {
  const heightfield::Ground ground = flat_ground();
  std::string all;
  for (const Fault& fault : check_reach(roller(), {{step}, {17}}, Pose::Identity(),
                                        GroundSurfaceView(ground), "mine.sdf", "digger"))
    all += fault.text() + "\n";
  return all;
}

TEST(CompactWithBucket, IsCheckedBeforeTheRun) {
  // Loam yields to wheels only.
  const std::string near = faults_of(press_ahead());
  EXPECT_NE(near.find("mine.sdf:17: warning"), std::string::npos) << near;
  EXPECT_NE(near.find("compaction_pressure_pa"), std::string::npos) << near;
  EXPECT_EQ(near.find("error"), std::string::npos) << near;
  Compact step = press_ahead();
  for (Vec2& p : step.polygon) p.x() += 2;
  const std::string far = faults_of(step);
  for (const char* part : {"mine.sdf:17: error", "step 1/compact/polygon_m", "out of reach",
                           "from the swing axis; there the bottom of the bucket lies level from"})
    EXPECT_NE(far.find(part), std::string::npos) << part << " is not in " << far;
}

}  // namespace
}  // namespace navvy::control::testing
