// SPDX-License-Identifier: Apache-2.0
#include "run/motion_energy.h"

#include <gtest/gtest.h>

#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "values.h"

namespace navvy::run {
namespace {

/// Returns a scene with the excavator on a small site of loam and one step of its program.
scene::Scene scene_with(const std::string& step, const std::string& world = "") {
  return scene_io::load_scene_from_string(
      R"(<?xml version="1.0"?>
<sdf version="1.9" xmlns:navvy="navvy">
  <world name="energy">
    <navvy:soil ref="loam"/>
    <navvy:ground>
      <size_m>24 20</size_m><origin_m>-12 -10.1</origin_m><depth_m>4</depth_m>
    </navvy:ground>
    <navvy:solver><cell_m>0.2</cell_m></navvy:solver>
    <include>
      <uri>model://ew180</uri><name>excavator</name><pose>-4 0 0 0 0 0</pose>
      <navvy:program>)" +
          step + R"(</navvy:program>
    </include>
)" + world +
          R"(
    <navvy:recording><duration_s>40</duration_s><settle_s>0.5</settle_s></navvy:recording>
  </world>
</sdf>)",
      "energy.sdf", control::step_kinds());
}

TEST(MotionEnergy, OfAMotionInTheAirIsTheSameWithAndWithoutSoil) {
  device::Device device;
  const EnergyComparison both = compare_motion_energy(scene_with(R"(
        <trajectory>
          <times_s>0 3 6</times_s>
          <joint name="boom_joint"><positions_deg>43 55 43</positions_deg></joint>
          <joint name="swing_joint"><positions_deg>0 30 0</positions_deg></joint>
        </trajectory>)"),
                                                      "", device);
  EXPECT_EQ(both.machine, "excavator");
  EXPECT_EQ(both.moved, 0);
  EXPECT_GT(both.with_soil.work, 10e3);
  // The motion is commanded by its positions and not by the program: 1 %.
  EXPECT_NEAR(both.without_soil.work, both.with_soil.work, 0.01 * both.with_soil.work);
  EXPECT_NEAR(both.without_soil.pump, both.with_soil.pump, 0.02 * both.with_soil.pump);
  EXPECT_LT(both.path_largest, 0.02);
  EXPECT_EQ(both.end.reason, EndReason::kComplete);
  EXPECT_TRUE(both.unfinished.empty());
}

TEST(MotionEnergy, TellsHowTheMotionEnded) {
  device::Device device;
  scene::Scene scene = scene_with("<wait><duration_s>5</duration_s></wait>");
  scene.recording.duration = 0.1;
  const EnergyComparison cut = compare_motion_energy(scene, "", device);
  EXPECT_EQ(cut.end.reason, EndReason::kOutOfTime);
  EXPECT_NEAR(cut.end.time, 0.1, 0.01);
  ASSERT_EQ(cut.unfinished.size(), 1u);
  EXPECT_NE(cut.unfinished[0].find("excavator"), std::string::npos) << cut.unfinished[0];
}

TEST(MotionEnergy, RefusesASecondMachineThatMayDig) {
  const std::string second = R"(
    <include>
      <uri>model://ew180</uri><name>second</name><pose>-4 6 0 0 0 0</pose>PROGRAM
    </include>)";
  const std::string wait = "<wait><duration_s>0.1</duration_s></wait>",
                    program = "<navvy:program>" + wait + "</navvy:program>";
  const auto with = [&](const std::string& text) {
    std::string all = second;
    return scene_with(wait, all.replace(all.find("PROGRAM"), 7, text));
  };
  device::Device device;
  EXPECT_THROW(compare_motion_energy(with(program), "excavator", device), InputError);
  // A parked one digs nothing.
  EXPECT_EQ(compare_motion_energy(with(""), "excavator", device).machine, "excavator");
}

TEST(MotionEnergy, OfAScoopIsLargerWithSoilByMoreThanItsLift) {
  device::Device device;
  const EnergyComparison both = compare_motion_energy(scene_with(R"(
        <dig>
          <from_m>4.85 0</from_m><to_m>1.65 0</to_m><depth_m>0.8</depth_m>
          <dump_at_m>-1.7 5.9</dump_at_m><dump_height_m>1.6</dump_height_m>
          <max_cycles>1</max_cycles>
        </dig>)"),
                                                      "excavator", device);
  EXPECT_EQ(both.cycles, 1);
  EXPECT_GT(both.moved, 200);
  const double more = both.with_soil.work - both.without_soil.work;
  print_value("work of a scoop in loam, with less without soil [J/kg]", more / both.moved,
              "more than its lift", "[docs/machines.md, ratings]");
  // The load is lifted from about 0.3 m below the ground to 1.6 m above it, and cut before.
  EXPECT_GT(more, 1.5 * kGravity * both.moved);
  EXPECT_LT(both.path_rms, 0.05);
  double joints = 0;
  for (const JointWork& one : both.joints) joints += one.with_soil;
  // All of the work is done by the arm: the drive holds its brake.
  EXPECT_NEAR(joints, both.with_soil.work, 0.03 * both.with_soil.work);
}

TEST(MotionEnergy, RefusesAMachineThatIsMissing) {
  device::Device device;
  const scene::Scene scene = scene_with("<wait><duration_s>0.1</duration_s></wait>");
  EXPECT_THROW(compare_motion_energy(scene, "digger", device), InputError);
}

}  // namespace
}  // namespace navvy::run
