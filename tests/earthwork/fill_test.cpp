// SPDX-License-Identifier: Apache-2.0
// Holes filled from a windrow: stations, faults that show before a run, and a whole fill in a
// closed loop; geometry only.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "control/activities/dig/backfill.h"
#include "control/dig_rig.h"
#include "control/ew180_like.h"
#include "control/simple_planners.h"
#include "core/saved_state.h"
#include "earthwork/pit_planner.h"
#include "log_lines.h"
#include "plan_text.h"

namespace navvy::earthwork {
namespace {

using control::Backfill;
using control::DigArea;
using control::JobPlan;
using control::testing::StraightPlanner;

constexpr double kWidth = 1.05;  // of bucket and trench [m]

DigArea trench(double length, double depth) {
  DigArea out;
  const double a = 0.5 * length, b = 0.5 * kWidth;
  out.polygon = {{-a, -b}, {a, -b}, {a, b}, {-a, b}};
  out.depth = depth;
  out.batter = radians(90);
  out.dump_at = Vec2(-5, 4.4);
  out.dump_to = Vec2(2, 4.4);
  out.has_dump_to = true;
  return out;
}

Backfill fill(double length) {
  Backfill out;
  out.polygon = trench(length, 0.5).polygon;
  out.heap = control::JobHeap{Vec2(-5, 4.4), Vec2(2, 4.4), 4};
  return out;
}

JobPlan plan_of(const Backfill& step, const heightfield::Ground& ground,
                const Pose& X_WB = make_pose(-10.5, 0, 0)) {
  const auto planner = job_planners()(control::testing::ew180_like());
  return planner->plan(step.job(), X_WB, control::GroundSurfaceView(ground));
}

TEST(FillPlan, WorksForwardsFromTheEndThatIsNearerAndBackOverTheSamePlaces) {
  const heightfield::Ground ground = control::testing::flat_ground();
  const JobPlan plan = plan_of(fill(6), ground);
  EXPECT_EQ(text_of(plan), "");
  ASSERT_EQ(plan.stations.size(), 5u);
  EXPECT_EQ(plan.stations[3].at.p, plan.stations[1].at.p);
  EXPECT_EQ(plan.stations[4].at.p, plan.stations[0].at.p);
  EXPECT_LT(plan.stations[0].at.p.x(), -7);
  EXPECT_NEAR(plan.stations[1].at.p.x() - plan.stations[0].at.p.x(), 3, 1e-6);
  EXPECT_NEAR(std::remainder(plan.stations[0].at.yaw, 2 * kPi), 0, 1e-9);
  // The same hole from its other end.
  const JobPlan back = plan_of(fill(4), ground, make_pose(10, 0, 0, 0, 0, kPi));
  ASSERT_FALSE(back.stations.empty());
  EXPECT_GT(back.stations[0].at.p.x(), 5);
  EXPECT_NEAR(std::abs(std::remainder(back.stations[0].at.yaw, 2 * kPi)), kPi, 1e-9);
}

TEST(FillPlan, FillsHigherWhereACompactionWillSettleTheGround) {
  const heightfield::Ground ground = control::testing::flat_ground();
  Backfill step = fill(6);
  EXPECT_NEAR(plan_of(step, ground).volume, 0, 1e-9);
  step.over = 0.05;
  // Columns of 0.1 m whose middle is inside.
  EXPECT_NEAR(plan_of(step, ground).volume, 0.05 * 6 * kWidth, 0.05 * 6 * 0.06);
  const auto planner = job_planners()(control::testing::ew180_like());
  EXPECT_NEAR(planner->volume(step.job(), control::GroundSurfaceView(ground)).rms, 0.05, 1e-6);
}

TEST(FillPlan, NamesAHeapInTheFillOneOutOfReachAndOneThatIsTooSmall) {
  heightfield::Ground ground = control::testing::flat_ground();
  Backfill step = fill(6);
  step.heap->from.y() = step.heap->to.y() = 2;
  EXPECT_NE(text_of(plan_of(step, ground)).find("4.00 m wide, is in the fill"), std::string::npos)
      << text_of(plan_of(step, ground));
  step = fill(6);
  step.heap->from.y() = step.heap->to.y() = 9;
  EXPECT_NE(text_of(plan_of(step, ground)).find("reaches no soil of the heap"), std::string::npos)
      << text_of(plan_of(step, ground));
  // A hole of 0.4 m3 and no heap.
  std::vector<heightfield::SoilLayer> taken;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 20; ++x) {
      const Vec2i at = ground.column_at(-1 + 0.1 * (x + 0.5), -0.2 + 0.1 * (y + 0.5));
      ground.take_above(at.x(), at.y(), -0.5, taken);
    }
  EXPECT_NE(text_of(plan_of(fill(6), ground)).find("smaller than the hole, which lacks 0.40 m3"),
            std::string::npos)
      << text_of(plan_of(fill(6), ground));
}

// The heap is used up: a mound at the near end, in the machine's way, goes into the hollow.
TEST(FillPlan, FillsAHollowFromAMoundOnceTheHeapIsUsedUp) {
  heightfield::Ground ground = control::testing::flat_ground();
  const auto columns = [&](double x0, double x1, const auto& use) {
    for (double x = x0 + 0.05; x < x1; x += 0.1)
      for (double y = -0.45; y < 0.5; y += 0.1) use(ground.column_at(x, y));
  };
  std::vector<heightfield::SoilLayer> taken;
  columns(-2.9, -2.1, [&](const Vec2i& at) { ground.take_above(at.x(), at.y(), -0.4, taken); });
  heightfield::SoilLayer layer;
  layer.mass = mass_units(0.3 * 0.1 * 0.1 * 1700);
  columns(-4.4, -3.9, [&](const Vec2i& at) { ground.put(at.x(), at.y(), layer); });
  const auto planner = job_planners()(control::testing::ew180_like());
  const std::vector<control::JobCut> cuts =
      planner->cuts(fill(6).job(), make_pose(-9, 0, 0), control::GroundSurfaceView(ground));
  ASSERT_FALSE(cuts.empty());
  for (const control::JobCut& cut : cuts) {
    EXPECT_TRUE(cut.has_dump_at);
    EXPECT_NEAR(cut.dump_at.x(), -2.5, 0.6);
    EXPECT_NEAR(cut.dump_at.y(), 0, 0.6);
    EXPECT_LT(cut.near.x(), -3.9);
    EXPECT_GT(cut.far.x(), -4.4);
  }
}

control::testing::DigRig rig_of(const DigArea& dig, const Backfill& step) {
  scene::Program program;
  program.steps = {dig, step};
  return {
      control::testing::ew180_like(),
      program,
      make_pose(-9.5, 0, 0),
      {[](const scene::Machine&) { return std::make_unique<StraightPlanner>(); }, job_planners()}};
}

TEST(Backfill, FillsATrenchFromItsOwnSpoil) {
  const LogLines log;
  control::testing::DigRig rig = rig_of(trench(5, 0.5), fill(5));
  // More soil than the trench gives: the rig drops each load on a circle wider than the trench.
  heightfield::SoilLayer layer;
  layer.mass = mass_units(0.25 * 0.1 * 0.1 * 1700);
  for (double x = -5; x < 2; x += 0.1)
    for (double y = 3.4; y < 5.4; y += 0.1) {
      const Vec2i at = rig.ground.column_at(x, y);
      rig.ground.put(at.x(), at.y(), layer);
    }
  const bool done = rig.run(3000);
  ASSERT_EQ(rig.op.reports().size(), 2u) << log.text();
  const control::StepReport& report = rig.op.reports().back();
  for (const control::Measurement& one : report.measurements)
    std::printf("%s %.3f\n", one.name.c_str(), one.value);
  std::printf("%zu cycles, %.0f s\n", rig.cycles.size(), rig.time);
  EXPECT_EQ(report.element, "backfill");
  const auto value = [&](const char* name) {
    const auto one = std::find_if(report.measurements.begin(), report.measurements.end(),
                                  [&](const auto& m) { return m.name == name; });
    return one == report.measurements.end() ? NAN : one->value;
  };
  EXPECT_GT(value("design_volume_m3"), 0.8 * 5 * kWidth * 0.5);
  EXPECT_LE(value("volume_left_m3"), 0.15 * value("design_volume_m3"));
  // The rig's soil stands at any angle: mounds that the passes leave remain, and the step says so.
  EXPECT_EQ(done, value("deviation_rms_m") <= 2 * fill(5).tolerance);
  if (!done) {
    EXPECT_NE(report.reason.find("deviates from the design"), std::string::npos) << report.reason;
  }
}

TEST(Backfill, ResumesBitIdenticallyInAScoop) {
  control::testing::DigRig whole = rig_of(trench(4, 0.3), fill(4)),
                           resumed = rig_of(trench(4, 0.3), fill(4));
  while (whole.time < 600 && (whole.op.progress().done < 1 || whole.op.phase() != "drag"))
    whole.step();
  ASSERT_EQ(whole.op.phase(), "drag");
  load_saved(saved(whole), resumed);
  for (int i = 0; i < 4000; ++i) {
    whole.step();
    resumed.step();
  }
  EXPECT_EQ(resumed.digest(), whole.digest());
}

}  // namespace
}  // namespace navvy::earthwork
