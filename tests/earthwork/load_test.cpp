// SPDX-License-Identifier: Apache-2.0
// Trucks loaded from a windrow and from a pit: faults that show before a run, and whole jobs in a
// closed loop; geometry only.
#include "control/activities/dig/load_trucks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "control/arm_kinematics.h"
#include "control/dig_pose.h"
#include "control/dig_rig.h"
#include "control/ew180_like.h"
#include "control/simple_planners.h"
#include "core/saved_state.h"
#include "earthwork/pit_planner.h"
#include "log_lines.h"
#include "plan_text.h"

namespace navvy::earthwork {
namespace {

using control::BedView;
using control::DigArea;
using control::LoadTrucks;
using control::StepReport;
using control::testing::DigRig;

constexpr double kLoad = 2400;  // of a truck [kg]

/// A windrow of 3 m ahead of a machine at (-4, 0); trucks stand beside it.
LoadTrucks load(int trucks) {
  LoadTrucks out;
  out.loads = trucks;
  out.heap = control::JobHeap{Vec2(1.5, -1.5), Vec2(1.5, 1.5), 4};
  out.dump_at = Vec2(-2, 6);
  out.dump_height = 2.3;
  out.into = {"truck"};
  out.load = kLoad;
  out.longest = 60;
  return out;
}

BedView bed_at(const Vec2& middle) { return {middle, Vec2(1.5, 0), 1.9, 0, 0}; }

/// Heaps soil of the height `height` [m] on the windrow of `load`.
void heap_up(heightfield::Ground& ground, double height) {
  heightfield::SoilLayer layer;
  layer.mass = mass_units(height * ground.cell() * ground.cell() * 1400);
  for (double x = 0.25; x < 2.75; x += ground.cell())
    for (double y = -2; y < 2; y += ground.cell()) {
      const Vec2i at = ground.column_at(x, y);
      ground.put(at.x(), at.y(), layer);
    }
}

DigRig rig_of(scene::ProgramStep step, const Pose& X_WM) {
  scene::Program program;
  program.steps = {std::move(step)};
  DigRig out{
      control::testing::ew180_like(),
      program,
      X_WM,
      {[](const scene::Machine&) { return std::make_unique<control::testing::StraightPlanner>(); },
       job_planners()}};
  return out;
}

double value(const StepReport& report, const std::string& name) {
  const auto one = std::find_if(report.measurements.begin(), report.measurements.end(),
                                [&](const auto& m) { return m.name == name; });
  return one == report.measurements.end() ? NAN : one->value;
}

/// Runs until the program ends. A truck comes 10 s after the one before it has its load, which
/// drives off 6 s after that.
void run_with_trucks(DigRig& rig, int trucks, const Vec2& place, double limit) {
  rig.fills_bed = true;
  const BedView away = bed_at(Vec2(50, 50));
  rig.bed = away;
  double due = 10, full = -1;
  while (!rig.op.ended() && rig.time < limit) {
    rig.step();
    if (full < 0 && rig.bed->middle == away.middle && trucks > 0 && rig.time >= due) {
      rig.bed = bed_at(place);
      rig.poured = 0;
      --trucks;
    }
    if (rig.bed->middle == away.middle || rig.poured < 0.96 * kLoad) continue;
    if (full < 0) full = rig.time;
    if (rig.time < full + 6) continue;
    rig.bed = away;
    full = -1;
    due = rig.time + 10;
  }
}

/// Returns the swing angle of the rig's arm [rad]; 0 is ahead.
double swing_of(const DigRig& rig) { return rig.engine->joint(0, 0).position; }

TEST(Load, NamesAHeapOutOfReachAndBedsOutOfReach) {
  const heightfield::Ground ground = control::testing::flat_ground();
  const auto planner = job_planners()(control::testing::ew180_like());
  const auto text = [&](const LoadTrucks& step) {
    return text_of(
        planner->plan(step.job(), make_pose(-4, 0, 0), control::GroundSurfaceView(ground)));
  };
  EXPECT_EQ(text(load(1)), "");
  LoadTrucks far = load(1);
  far.heap->from.x() = far.heap->to.x() = 9;
  EXPECT_NE(text(far).find("no soil of the heap is within reach"), std::string::npos) << text(far);
  far = load(1);
  far.dump_at.y() = 10;
  EXPECT_NE(text(far).find("cannot be opened over the beds"), std::string::npos) << text(far);
}

TEST(Load, BeginsCutsWhereTheStickClearsTheHeap) {
  heightfield::Ground ground = control::testing::flat_ground();
  heap_up(ground, 1.8);
  const scene::Machine machine = control::testing::ew180_like();
  const control::ArmKinematics arm(machine);
  const control::GroundSurfaceView surface(ground);
  const Pose X_WB = make_pose(-4, 0, 0), X_WS = X_WB * arm.X_BS();
  LoadTrucks step = load(1);
  step.pass_depth = 0.7;
  const auto cuts = job_planners()(machine)->cuts(step.job(), X_WB, surface);
  ASSERT_FALSE(cuts.empty());
  for (const control::JobCut& cut : cuts) {
    const control::SwingPoint tip =
        control::swing_point(X_WS, Vec3(cut.far.x(), cut.far.y(), cut.floor.back()));
    control::BucketPose pose{tip.reach, tip.height, control::with_cut(arm, control::kPlunge)};
    control::ArmAngles q;
    ASSERT_TRUE(arm.inverse_nearest(pose, q));
    for (double along = 0; along <= 1.5; along += 0.1) {
      const Vec2 at = arm.on_stick(q, along);
      const Vec3 p =
          X_WS * Vec3(at.x() * std::cos(tip.swing), at.x() * std::sin(tip.swing), at.y());
      EXPECT_GT(p.z(), surface.height(p.x(), p.y()) + 0.25) << cut.far.transpose();
    }
  }
}

TEST(Load, HoldsTheBucketOverTheBedWhileItsSoilLands) {
  DigRig rig = rig_of(load(1), make_pose(-4, 0, 0));
  heap_up(rig.ground, 1.2);
  rig.fills_bed = true;
  rig.bed = bed_at(load(1).dump_at);
  const int bucket = control::testing::ew180_like().link_index("bucket");
  const auto place = [&] { return Vec3(rig.engine->link(0, bucket).X_WL.translation()); };
  Vec3 held = place();
  double moved = -1;
  while (!rig.op.ended() && rig.time < 200) {
    rig.step();
    if (rig.cycles.empty() || rig.cycles.back().end == 0) continue;
    const double since = rig.time - rig.cycles.back().end;
    if (since < 0.1) held = place();
    // The pause takes 2 s.
    if (since > 0.1 && since < 1.9) moved = std::max(moved, (place() - held).norm());
  }
  EXPECT_GT(rig.cycles.size(), 2u);
  EXPECT_GE(moved, 0);
  EXPECT_LT(moved, 0.05);  // joints settle
}

TEST(Load, LoadsTwoTrucksByEqualPassesAndWaitsForEach) {
  const LogLines log;
  DigRig rig = rig_of(load(2), make_pose(-4, 0, 0));
  heap_up(rig.ground, 1.2);
  rig.load_centre = load(2).dump_at + Vec2(0.3, -0.4);
  run_with_trucks(rig, 2, load(2).dump_at, 600);
  ASSERT_TRUE(rig.op.done()) << log.text();
  const StepReport& report = rig.op.reports().at(0);
  EXPECT_EQ(value(report, "loads"), 2);
  // The rig's bucket fills on in its curl, by up to half of a pass.
  for (const char* name : {"load_1_kg", "load_2_kg"}) {
    EXPECT_GE(value(report, name), 0.96 * kLoad);
    EXPECT_LE(value(report, name), 1.16 * kLoad);
  }
  EXPECT_NEAR(value(report, "load_offset_m"), 0.5, 1e-9);
  EXPECT_GT(value(report, "waited_s"), 15);
  std::printf("%zu cycles, %.0f s\n", rig.cycles.size(), rig.time);
  EXPECT_LE(rig.cycles.size(), 10u);
}

TEST(Load, CentresALoadThatLandsBesideTheTip) {
  const LogLines log;
  DigRig rig = rig_of(load(1), make_pose(-4, 0, 0));
  heap_up(rig.ground, 1.2);
  rig.lands_off = Vec2(-0.25, 0.35);
  run_with_trucks(rig, 1, load(1).dump_at, 600);
  ASSERT_TRUE(rig.op.done()) << log.text();
  // Three passes; 0.58 m without a correction.
  EXPECT_LT(value(rig.op.reports().at(0), "load_offset_m"), 0.4);
}

TEST(Load, TakesAThinSliceForASmallRest) {
  const LogLines log;
  DigRig rig = rig_of(load(1), make_pose(-4, 0, 0));
  heap_up(rig.ground, 1.2);
  rig.fills_bed = true;
  rig.bed = bed_at(load(1).dump_at);
  constexpr double kMissing = 300;
  rig.poured = kLoad - kMissing;
  rig.run(200);
  ASSERT_TRUE(rig.op.done()) << log.text();
  ASSERT_EQ(rig.cycles.size(), 1u);
  std::printf("%.0f kg where %.0f kg are missing\n", rig.cycles[0].payload, kMissing);
  EXPECT_GT(rig.cycles[0].payload, 0.7 * kMissing);
  // A whole slice brings 1050 kg.
  EXPECT_LT(rig.cycles[0].payload, 2 * kMissing);
}

TEST(Load, EndsWhenNoTruckComesAndSaysWhereTheyAre) {
  const LogLines log;
  DigRig rig = rig_of(load(1), make_pose(-4, 0, 0));
  heap_up(rig.ground, 1.2);
  rig.fills_bed = true;
  rig.bed = bed_at(Vec2(8, 6));
  rig.run(200);
  ASSERT_EQ(rig.op.reports().size(), 1u) << log.text();
  EXPECT_EQ(rig.op.reports()[0].state, control::StepState::kOutOfTime);
  EXPECT_NEAR(rig.time, 65, 8);
  EXPECT_NE(rig.op.reports()[0].reason.find("'truck' stands at (8.00 , 6.00 ) with 0.00 kg"),
            std::string::npos)
      << rig.op.reports()[0].reason;
}

TEST(Load, EndsWhenTheHeapIsTaken) {
  const LogLines log;
  DigRig rig = rig_of(load(3), make_pose(-4, 0, 0));
  heap_up(rig.ground, 0.3);
  run_with_trucks(rig, 3, load(3).dump_at, 900);
  ASSERT_EQ(rig.op.reports().size(), 1u) << log.text();
  EXPECT_EQ(rig.op.reports()[0].state, control::StepState::kBlocked);
  EXPECT_NE(rig.op.reports()[0].reason.find("the heap gives no more soil"), std::string::npos)
      << rig.op.reports()[0].reason;
  // The bucket is not left over the bed.
  EXPECT_NEAR(swing_of(rig), 0, radians(3));
}

DigArea pit() {
  DigArea out;
  out.polygon = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  out.depth = 0.6;
  out.batter = radians(45);
  out.dump_at = out.dump_to = Vec2(-5, 6);
  out.dump_height = 2.3;
  out.into = {"truck"};
  out.load = kLoad;
  return out;
}

TEST(DigArea, LoadsWhatItDigsIntoTrucks) {
  const LogLines log;
  DigRig rig = rig_of(pit(), make_pose(-8, 0, 0));
  run_with_trucks(rig, 10, pit().dump_at, 1200);
  ASSERT_TRUE(rig.op.done()) << log.text();
  const StepReport& report = rig.op.reports().at(0);
  double dug = 0;
  for (int iy = 0; iy < rig.ground.ny(); ++iy)
    for (int ix = 0; ix < rig.ground.nx(); ++ix)
      dug += (rig.ground.start_height(ix, iy) - rig.ground.height(ix, iy)) * rig.ground.cell() *
             rig.ground.cell();
  EXPECT_LE(value(report, "volume_left_m3"), 0.15 * value(report, "design_volume_m3"));
  // All of it went into the trucks: three are filled and one has the rest. What the bucket spills
  // in the pit lies there loose.
  EXPECT_NEAR(value(report, "loaded_kg"), dug * rig.ground.setup().soils[0].bank_density,
              0.05 * value(report, "loaded_kg"));
  EXPECT_GE(value(report, "loads"), 2);
  EXPECT_NEAR(swing_of(rig), 0, radians(3));
}

TEST(Load, ResumesBitIdenticallyWhileItWaitsAndInAScoop) {
  for (const char* phase : {"wait", "drag"}) {
    DigRig whole = rig_of(load(1), make_pose(-4, 0, 0)),
           resumed = rig_of(load(1), make_pose(-4, 0, 0));
    for (DigRig* one : {&whole, &resumed}) {
      heap_up(one->ground, 1.2);
      one->fills_bed = true;
      if (phase[0] == 'd') one->bed = bed_at(load(1).dump_at);
    }
    while (whole.time < 100 && whole.op.phase() != phase) whole.step();
    ASSERT_EQ(whole.op.phase(), phase);
    load_saved(saved(whole), resumed);
    whole.bed = resumed.bed = bed_at(load(1).dump_at);
    for (int i = 0; i < 6000; ++i) {
      whole.step();
      resumed.step();
    }
    EXPECT_EQ(resumed.digest(), whole.digest());
  }
}

}  // namespace
}  // namespace navvy::earthwork
