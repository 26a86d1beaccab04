// SPDX-License-Identifier: Apache-2.0
// Pits from several stations: plans, faults that show before a run, and whole pits in a closed
// loop; geometry only.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "control/activities/dig/dig_area.h"
#include "control/activities/dig/grade.h"
#include "control/activities/go_to.h"
#include "control/dig_rig.h"
#include "control/ew180_like.h"
#include "control/reach.h"
#include "control/simple_planners.h"
#include "core/saved_state.h"
#include "earthwork/pit_checks.h"
#include "earthwork/pit_planner.h"
#include "heightfield/design_surface.h"
#include "log_lines.h"
#include "plan_text.h"

namespace navvy::earthwork {
namespace {

using control::DigArea;
using control::Grade;
using control::JobPlan;
using control::testing::BlockedPlanner;
using control::testing::StraightPlanner;

control::Planners planners() {
  return {[](const scene::Machine&) { return std::make_unique<StraightPlanner>(); },
          job_planners()};
}

/// A pit with a rectangular floor about (x, 0), and a windrow along its side.
DigArea pit(double length, double width, double depth, double batter = 45, double x = 0) {
  DigArea out;
  const double a = 0.5 * length, b = 0.5 * width;
  out.polygon = {{x - a, -b}, {x + a, -b}, {x + a, b}, {x - a, b}};
  out.depth = depth;
  out.batter = radians(batter);
  out.dump_at = Vec2(-10, 6.4);
  out.dump_to = Vec2(-1, 6.4);
  out.has_dump_to = true;
  return out;
}

/// A floor with steep sides that is levelled, dumped on a heap.
Grade steep_floor(double length, double width, double depth, const Vec2& dump_at) {
  Grade out;
  out.polygon = pit(length, width, depth, 90).polygon;
  out.depth = depth;
  out.batter = radians(90);
  out.dump_at = out.dump_to = dump_at;
  return out;
}

JobPlan plan_of(const DigArea& step, const Pose& X_WB = make_pose(-10.5, 0, 0)) {
  const heightfield::Ground ground = control::testing::flat_ground();
  const auto planner = job_planners()(control::testing::ew180_like());
  return planner->plan(step.job(), X_WB, control::GroundSurfaceView(ground));
}

TEST(PitPlan, DigsTheJobOfRecordFromTwoStationsOnItsAxis) {
  const JobPlan plan = plan_of(pit(4, 3, 1.5));
  EXPECT_EQ(text_of(plan), "");
  // 12 m2 of floor, sides of 1:1 that end in quarter cones: 18 + 7 x 1.125 x 2 + pi 1.5^3 / 3.
  EXPECT_NEAR(plan.volume, 18 + 2 * 7 * 1.125 + kPi * 1.125, 0.4);
  ASSERT_EQ(plan.stations.size(), 2u);
  double sum = 0;
  for (const control::JobStation& one : plan.stations) {
    EXPECT_NEAR(one.at.p.y(), 0, 0.11);  // the axis is the middle of the columns
    EXPECT_NEAR(std::remainder(one.at.yaw, 2 * kPi), 0, 1e-9);
    EXPECT_GT(one.cuts, 5);
    sum += one.volume;
  }
  EXPECT_LT(plan.stations[1].at.p.x(), plan.stations[0].at.p.x() - 2) << "the machine backs";
  // Without soil below the least depth that decides a station.
  EXPECT_NEAR(sum, plan.volume, 0.06 * plan.volume);
}

TEST(PitPlan, DigsALongPitFromMoreStations) {
  const JobPlan plan = plan_of(pit(6, 3, 1.5, 45, 3));
  EXPECT_EQ(text_of(plan), "");
  EXPECT_GE(plan.stations.size(), 3u);
}

TEST(PitPlan, CutsRunOutBeyondTheNearEdge) {
  // The floor of a cut ends on the ground, where the bucket curls: a curl leaves a ramp.
  const heightfield::Ground ground = control::testing::flat_ground();
  const auto planner = job_planners()(control::testing::ew180_like());
  const DigArea step = pit(2, 2, 0.6);
  const std::vector<control::JobCut> cuts =
      planner->cuts(step.job(), make_pose(-7, 0, 0), control::GroundSurfaceView(ground));
  ASSERT_FALSE(cuts.empty());
  for (const control::JobCut& cut : cuts) {
    EXPECT_LT(*std::min_element(cut.floor.begin(), cut.floor.end()), -0.25);
    // Floors are 0.1 m apart; a side so shallow that no scoop asks for it is before the soil, too.
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(cut.floor.at(i), 0, 1e-6) << i;
  }
  // A vertical side would throw the bucket up.
  for (const control::JobCut& cut : planner->cuts(pit(3, 3, 0.4, 90).job(), make_pose(-7, 0, 0),
                                                  control::GroundSurfaceView(ground)))
    EXPECT_LT(cut.floor.front(), -0.3);
}

constexpr double kSteepY = -4;  // of the middle of a steep pit [m]

/// A pit with vertical sides, and a windrow behind a machine that digs it from y > 0.
DigArea steep(double length, double width, double depth) {
  DigArea out = pit(length, width, depth, 90);
  for (Vec2& corner : out.polygon) corner.y() += kSteepY;
  out.dump_at = Vec2(-8, 9.5);
  out.dump_to = Vec2(8, 9.5);
  return out;
}

TEST(PitPlan, DigsSteepSidesInLanesSquareToThem) {
  const DigArea step = steep(6, 3, 0.5);
  const JobPlan plan = plan_of(step);
  EXPECT_EQ(text_of(plan), "");
  ASSERT_EQ(plan.stations.size(), 3u);
  const double half = 0.5 * control::testing::ew180_like().buckets[0].width;
  std::vector<double> places;
  double sum = 0;
  for (const control::JobStation& one : plan.stations) {
    EXPECT_NEAR(std::abs(std::remainder(one.at.yaw, 2 * kPi)), 0.5 * kPi, 1e-9);
    // It stands outside, on ground that is not dug.
    EXPECT_GT(std::abs(one.at.p.y() - kSteepY), 1.5 + 2);
    places.push_back(one.at.p.x());
    sum += one.volume;
  }
  std::sort(places.begin(), places.end());
  // In line with the sides, and between them.
  EXPECT_NEAR(places[0], -3 + half, 0.06);
  EXPECT_NEAR(places[1], 0, 0.06);
  EXPECT_NEAR(places[2], 3 - half, 0.06);
  EXPECT_NEAR(sum, plan.volume, 0.07 * plan.volume);
  // A trench one bucket wide, and a floor that is levelled, are dug along their length.
  for (const control::JobStation& one : plan_of(pit(6, 1, 0.5, 90)).stations)
    EXPECT_NEAR(std::sin(one.at.yaw), 0, 1e-9);
}

TEST(PitPlan, CutsOfSteepSidesAreSquareHoweverTheMachineStands) {
  const heightfield::Ground ground = control::testing::flat_ground();
  const control::GroundSurfaceView surface(ground);
  const auto planner = job_planners()(control::testing::ew180_like());
  const DigArea step = steep(6, 3, 0.5);
  // Askew by 4 deg, at the station of the lane in the middle.
  const JobPlan plan = plan_of(step);
  const auto middle = std::min_element(
      plan.stations.begin(), plan.stations.end(),
      [](const auto& a, const auto& b) { return std::abs(a.at.p.x()) < std::abs(b.at.p.x()); });
  ASSERT_NE(middle, plan.stations.end());
  const double side = std::copysign(1.0, middle->at.p.y() - kSteepY);
  const Pose X_WB =
      make_pose(middle->at.p.x(), middle->at.p.y(), 0, 0, 0, middle->at.yaw + radians(4));
  const std::vector<control::JobCut> cuts = planner->cuts(step.job(), X_WB, surface);
  ASSERT_FALSE(cuts.empty());
  double least = 1;
  for (const control::JobCut& cut : cuts) {
    const Vec2 line = (cut.near - cut.far).normalized();
    const bool square = std::abs(line.x()) < 1e-3;
    least = std::min(least, std::abs(line.x()));
    // Within the lane.
    EXPECT_LE(std::max(std::abs(cut.near.x()), std::abs(cut.far.x())), 1.9);
    // They go on beyond both sides at the depth of their layer.
    EXPECT_LT(cut.floor.front(), -0.24);
    EXPECT_GT(side * (cut.near.y() - kSteepY), 1.5);
    if (square && !cut.levels) EXPECT_NEAR(side * (cut.far.y() - kSteepY), -1.65, 0.15);
  }
  EXPECT_LT(least, 1e-3) << "one is square to the sides";
}

TEST(PitPlan, CutsOfATrenchRunOutBeyondItsNearEndAtTheDepthOfTheFloor) {
  // The curl's ramp would be left in the trench; the levelling pass runs out, too.
  const heightfield::Ground ground = control::testing::flat_ground();
  const auto planner = job_planners()(control::testing::ew180_like());
  const Grade step = steep_floor(3, 1, 0.4, Vec2(-3, 6.4));
  const std::vector<control::JobCut> cuts =
      planner->cuts(step.job(), make_pose(-7, 0, 0), control::GroundSurfaceView(ground));
  int levelling = 0;
  for (const control::JobCut& cut : cuts) {
    levelling += cut.levels ? 1 : 0;
    EXPECT_NEAR(cut.near.x(), -1.5 - 0.6, 0.16);
    EXPECT_NEAR(cut.floor.front(), -0.4, 1e-6);
  }
  EXPECT_EQ(levelling, 1);
  EXPECT_GE(cuts.size(), 2u);
}

TEST(PitPlan, LevelsAWideFloorUpToItsSteepSides) {
  const heightfield::Ground ground = control::testing::flat_ground();
  const auto planner = job_planners()(control::testing::ew180_like());
  const Grade step = steep_floor(8, 4, 0.2, Vec2(-6, 7));
  const JobPlan plan =
      planner->plan(step.job(), make_pose(-10.5, 0, 0), control::GroundSurfaceView(ground));
  ASSERT_GE(plan.stations.size(), 2u);
  double near = 0, far = 0, side = 0;
  for (const control::JobStation& one : plan.stations)
    for (const control::JobCut& cut :
         planner->cuts(step.job(), make_pose(one.at.p.x(), one.at.p.y(), 0, 0, 0, one.at.yaw),
                       control::GroundSurfaceView(ground))) {
      side = std::max(side, std::abs(cut.far.y()));
      if (!cut.levels) continue;
      EXPECT_NEAR(cut.floor.front(), -0.2, 1e-6);
      EXPECT_NEAR(cut.floor.back(), -0.2, 1e-6);
      near = std::min(near, cut.near.x());
      far = std::max(far, cut.far.x());
    }
  // Out of the near side for the ramp of the curl, and into the far one.
  EXPECT_LT(near, -4 - 0.3);
  EXPECT_GT(far, 4 + 0.1);
  // The bucket, half of it 0.52 m, reaches over the sides by 0.4 m at most.
  EXPECT_GT(side, 2 - 0.52 + 0.1);
}

TEST(PitPlan, DumpsOnTheLowerOfTwoWindrows) {
  heightfield::Ground ground = control::testing::flat_ground();
  const auto planner = job_planners()(control::testing::ew180_like());
  DigArea step = pit(4, 3, 1.5);
  step.second_windrow = {-10, -6.4, -1, -6.4};
  const Pose X_WB = make_pose(-5, 0, 0);
  const auto dumped = [&] {
    const std::vector<control::JobCut> cuts =
        planner->cuts(step.job(), X_WB, control::GroundSurfaceView(ground));
    return cuts.empty() || !cuts.front().has_dump_at ? 0 : cuts.front().dump_at.y();
  };
  EXPECT_NEAR(dumped(), 6.4, 1e-9);
  heightfield::SoilLayer layer;
  layer.mass = mass_units(0.5 * 0.1 * 0.1 * 1700);
  for (double x = -11; x < 0; x += 0.1)
    for (double y = 5.5; y < 7.5; y += 0.1) {
      const Vec2i at = ground.column_at(x + 0.05, y + 0.05);
      ground.put(at.x(), at.y(), layer);
    }
  EXPECT_NEAR(dumped(), -6.4, 1e-9);
  step.second_windrow = {-10, -2.9, -1, -2.9};
  EXPECT_NE(text_of(plan_of(step)).find("must fall 0.50 m clear"), std::string::npos)
      << text_of(plan_of(step));
}

TEST(PitPlan, DigsLongSteepPitsRowByRow) {
  // Longer than the reach in both directions: no station stands on dug ground.
  DigArea step = steep(9, 8, 0.4);
  step.dump_at = Vec2(-11.5, -9);
  step.dump_to = Vec2(-11.5, 9);
  const JobPlan plan = plan_of(step);
  ASSERT_GT(plan.stations.size(), 3u);
  const double yaw = plan.stations.front().at.yaw;
  const Vec2 ahead(std::cos(yaw), std::sin(yaw));
  double last = 1e9;
  for (const control::JobStation& one : plan.stations) {
    EXPECT_EQ(one.at.yaw, yaw);
    EXPECT_LE(one.at.p.dot(ahead), last + 1);
    last = one.at.p.dot(ahead);
  }
}

TEST(PitPlan, NamesSpoilWhereTheMachineStands) {
  DigArea step = steep(6, 3, 0.5);
  // Both sides of the pit.
  step.dump_at = Vec2(-3, 3.5);
  step.dump_to = Vec2(3, 3.5);
  const std::string text = text_of(plan_of(step));
  EXPECT_TRUE(text.find("the spoil would lie where the machine stands") != std::string::npos ||
              text.find("nowhere on the windrow") != std::string::npos)
      << text;
}

TEST(PitPlan, DependsOnItsArgumentsAlone) {
  const heightfield::Ground ground = control::testing::flat_ground();
  const control::GroundSurfaceView surface(ground);
  const auto used = job_planners()(control::testing::ew180_like());
  used->plan(pit(2, 2, 0.5).job(), make_pose(-10, 0, 0), surface);
  const auto fresh = job_planners()(control::testing::ew180_like());
  const control::PitJob job = pit(4, 3, 1.5).job();
  const JobPlan a = used->plan(job, make_pose(-10.5, 0, 0), surface),
                b = fresh->plan(job, make_pose(-10.5, 0, 0), surface);
  ASSERT_EQ(a.stations.size(), b.stations.size());
  for (std::size_t i = 0; i < a.stations.size(); ++i)
    EXPECT_EQ(a.stations[i].at.p, b.stations[i].at.p);
}

TEST(PitPlan, NamesSpoilInsideTheDig) {
  DigArea step = pit(4, 3, 1.5);
  step.dump_at = Vec2(-3, 3.2);
  EXPECT_NE(text_of(plan_of(step)).find("dump_at_m: (-3.00 , 3.20 ): spoil must fall 0.50 m clear"),
            std::string::npos)
      << text_of(plan_of(step));
}

TEST(PitPlan, NamesSpoilOutOfReach) {
  DigArea step = pit(4, 3, 1.5);
  step.has_dump_to = false;
  step.dump_at = Vec2(9, 9);
  EXPECT_NE(text_of(plan_of(step)).find("the bucket can be opened nowhere on the windrow"),
            std::string::npos)
      << text_of(plan_of(step));
}

TEST(PitPlan, NamesSidesThatAreSteeperThanTheSoilStands) {
  // Vertical, 3.5 m deep: Culmann's height of loam is 4 c / (rho g) cos phi / (1 - sin phi) = 2.3
  // m.
  const std::string text = text_of(plan_of(pit(4, 3, 3.5, 90)));
  EXPECT_NE(text.find("batter_deg: 90.00 deg: 'loam' stands at that angle up to 2.29 m"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("at most "), std::string::npos);
}

TEST(PitPlan, NamesSoilThatNoStationReaches) {
  // 7 m deep: the arm reaches 5 m below the ground.
  const std::string text = text_of(plan_of(pit(4, 3, 7, 30)));
  EXPECT_NE(text.find("no station reaches "), std::string::npos) << text;
}

TEST(PitChecks, SoilStandsAtItsAngleOfFrictionAtAnyHeight) {
  const scene::Soil loam;
  EXPECT_TRUE(std::isinf(standing_height(loam, loam.friction_angle)));
  EXPECT_GT(standing_height(loam, radians(45)), standing_height(loam, radians(90)));
}

/// Ground in a pit compared with its design, over the columns of the design.
struct PitMeasure {
  double volume_error = 0, over_rms = 0, left = 0;
};
PitMeasure measure(const heightfield::Ground& ground, const DigArea& step) {
  const heightfield::DesignSurface design = heightfield::design_of_area(*step.area(), ground, "");
  const heightfield::DesignComparison volumes = heightfield::against_design(ground, design);
  double over = 0, columns = 0;
  for (int iy = design.rect.y0; iy < design.rect.y1; ++iy)
    for (int ix = design.rect.x0; ix < design.rect.x1; ++ix) {
      const auto z = static_cast<double>(design.at(ix, iy));
      if (std::isnan(z)) continue;
      ++columns;
      over += std::pow(std::max(0.0, z - ground.height(ix, iy)), 2);
    }
  const double wanted = volumes.design_cut - volumes.design_fill, dug = volumes.cut - volumes.fill;
  const PitMeasure out{dug / wanted - 1, std::sqrt(over / columns), volumes.under_dig};
  std::printf("volume %+.3f, over-dig rms %.3f m, left %.2f m3\n", out.volume_error, out.over_rms,
              out.left);
  return out;
}

control::testing::DigRig rig_of(const DigArea& step, const Pose& X_WM) {
  scene::Program program;
  program.steps = {step};
  return {control::testing::ew180_like(), program, X_WM, planners()};
}

TEST(DigArea, DigsAPitFromOneStation) {
  const LogLines log;
  const DigArea step = pit(2, 2, 0.6);
  control::testing::DigRig rig = rig_of(step, make_pose(-9, 0, 0));
  ASSERT_TRUE(rig.run(900)) << rig.op.phase() << "\n" << log.text();
  const PitMeasure measured = measure(rig.ground, step);
  std::printf("%zu cycles, %.0f s\n", rig.cycles.size(), rig.time);
  EXPECT_NEAR(measured.volume_error, 0, 0.12);  // a step that is done leaves at most 15 %
  EXPECT_LE(measured.over_rms, 0.1);            // the job of record
  // No more cycles than twice the loads of the volume.
  EXPECT_LE(rig.cycles.size(), 30u);
}

TEST(DigArea, BacksFromStationToStation) {
  const LogLines log;
  // The job of record.
  const DigArea step = pit(4, 3, 1.5);
  control::testing::DigRig rig = rig_of(step, make_pose(-10.5, 0, 0));
  ASSERT_TRUE(rig.run(3000)) << rig.op.phase() << "\n" << log.text();
  const PitMeasure measured = measure(rig.ground, step);
  std::printf("%zu cycles, %.0f s\n", rig.cycles.size(), rig.time);
  EXPECT_NEAR(measured.volume_error, 0, 0.05);  // the job of record
  EXPECT_LE(measured.over_rms, 0.1);            // the job of record
  const std::vector<control::Measurement>& account = rig.op.reports().back().measurements;
  const auto stations = std::find_if(account.begin(), account.end(),
                                     [](const auto& one) { return one.name == "stations"; });
  ASSERT_NE(stations, account.end());
  EXPECT_GE(stations->value, 2);
}

TEST(Grade, LevelsAPlaneThatFalls) {
  const LogLines log;
  Grade step;
  step.polygon = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
  step.depth = 0.12;
  step.fall = radians(1);
  step.fall_yaw = radians(90);
  step.dump_at = Vec2(-10, 6.4);
  step.dump_to = Vec2(-1, 6.4);
  step.has_dump_to = true;
  scene::Program program;
  program.steps = {step};
  control::testing::DigRig rig(control::testing::ew180_like(), program, make_pose(-10.5, 0, 0),
                               planners());
  ASSERT_TRUE(rig.run(3000)) << rig.op.phase() << "\n" << log.text();
  measure(rig.ground, step);
  std::printf("%zu cycles, %.0f s\n", rig.cycles.size(), rig.time);
  const control::StepReport& report = rig.op.reports().back();
  EXPECT_EQ(report.element, "grade");
  const auto rms = std::find_if(report.measurements.begin(), report.measurements.end(),
                                [](const auto& one) { return one.name == "deviation_rms_m"; });
  ASSERT_NE(rms, report.measurements.end());
  // It says that it is done: at most twice the tolerance.
  EXPECT_LE(rms->value, 0.06);
}

TEST(DigArea, LeavesOutStationsThatItCannotReachAndSaysWhy) {
  const LogLines log;
  scene::Program program;
  program.steps = {pit(4, 3, 1.5)};
  // Square to the axis of the pit, so that no straight drive leads to a station.
  control::testing::DigRig rig(
      control::testing::ew180_like(), program, make_pose(-10.5, 0, 0, 0, 0, radians(90)),
      {[](const scene::Machine&) { return std::make_unique<BlockedPlanner>(); }, job_planners()});
  EXPECT_FALSE(rig.run(600));
  ASSERT_FALSE(rig.op.reports().empty());
  const control::StepReport& report = rig.op.reports().back();
  EXPECT_EQ(report.state, control::StepState::kBlocked);
  EXPECT_NE(report.reason.find("what is left could not be dug"), std::string::npos)
      << report.reason;
  EXPECT_NE(report.reason.find("station 2 of 2 was not reached"), std::string::npos)
      << report.reason;
  const auto missed = std::find_if(report.measurements.begin(), report.measurements.end(),
                                   [](const auto& one) { return one.name == "stations_missed"; });
  ASSERT_NE(missed, report.measurements.end());
  EXPECT_EQ(missed->value, 2);
}

TEST(DigArea, EndsWhereTheSpoilIsTooHighToDumpOn) {
  const LogLines log;
  const DigArea step = pit(2, 2, 0.6);
  control::testing::DigRig rig = rig_of(step, make_pose(-9, 0, 0));
  heightfield::SoilLayer layer;
  layer.mass = mass_units(8 * 0.1 * 0.1 * 1700);
  for (double x = -11; x < 0; x += 0.1)
    for (double y = 5.4; y < 7.4; y += 0.1) {
      const Vec2i at = rig.ground.column_at(x + 0.05, y + 0.05);
      rig.ground.put(at.x(), at.y(), layer);
    }
  EXPECT_FALSE(rig.run(120));
  ASSERT_FALSE(rig.op.reports().empty());
  const control::StepReport& report = rig.op.reports().back();
  EXPECT_EQ(report.state, control::StepState::kBlocked);
  EXPECT_NE(report.reason.find("the spoil is too high for the bucket to open over it anywhere"),
            std::string::npos)
      << report.reason;
  EXPECT_TRUE(rig.cycles.empty());
}

TEST(DigArea, LeavesPathsOfLaterStepsUntilItIsDone) {
  control::GoTo near, away;
  near.target = Vec2(-8, 0);
  away.target = Vec2(-10, 0);
  scene::Program program;
  program.steps = {near, pit(2, 2, 0.6), away};
  control::testing::DigRig rig(control::testing::ew180_like(), program, make_pose(-9, 0, 0),
                               planners());
  rig.step();
  // Where the job ends is not known when the program begins.
  ASSERT_EQ(rig.op.paths().size(), 1u);
  EXPECT_EQ(rig.op.paths()[0].step, 1);
}

TEST(DigArea, ResumesBitIdenticallyInACut) {
  const DigArea step = pit(2, 2, 0.4);
  control::testing::DigRig whole = rig_of(step, make_pose(-9, 0, 0)),
                           resumed = rig_of(step, make_pose(-9, 0, 0));
  while (whole.cycles.size() < 2 || whole.op.phase() != "drag") whole.step();
  const std::vector<char> bytes = saved(whole);
  load_saved(bytes, resumed);
  EXPECT_EQ(resumed.digest(), whole.digest());
  for (int i = 0; i < 4000; ++i) {
    whole.step();
    resumed.step();
  }
  EXPECT_EQ(resumed.digest(), whole.digest());
}

}  // namespace
}  // namespace navvy::earthwork
