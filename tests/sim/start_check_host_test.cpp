// SPDX-License-Identifier: Apache-2.0
// Machines that start in the ground are named, except for those that may be partly in it.
#include "sim/start_check.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "heightfield/make_ground.h"
#include "sim/scenes.h"
#include "sim/start_placing.h"

namespace navvy::sim {
namespace {

/// Returns the faults of the initial poses of these machines on flat loam, with its surface at 0.
std::vector<Fault> faults_of(const std::string& machines) {
  return check_start(scene_io::load_scene_from_string(
                         "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil "
                         "ref=\"loam\"/>"
                         "<navvy:ground><size_m>24 20</size_m></navvy:ground>" +
                             machines + "</world></sdf>",
                         "w.sdf", control::step_kinds()))
      .faults;
}

std::string stone(const std::string& height, const std::string& about) {
  return "<model name=\"stone\"><pose>1 2 " + height +
         " 0 0 0</pose><navvy:on_ground>false</navvy:on_ground>" + about +
         "<link name=\"rock\"><navvy:density_kg_per_m3>2600</navvy:density_kg_per_m3><collision "
         "name=\"c\"><geometry>"
         "<box><size>0.6 0.6 0.4</size></box></geometry></collision></link></model>";
}

std::string digger(const std::string& height) {
  return "<include><uri>model://ew180</uri><name>digger</name><pose>0 0 " + height +
         " 0 0 0</pose><navvy:on_ground>false</navvy:on_ground></include>";
}

void expect_one(const std::vector<Fault>& faults, const std::vector<std::string>& parts,
                Fault::Severity severity = Fault::Severity::kError) {
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].severity, severity);
  for (const std::string& part : parts)
    EXPECT_NE(faults[0].text().find(part), std::string::npos)
        << "'" << part << "' is not in: " << faults[0].text();
}

TEST(StartCheck, NamesABodyThatStartsBelowTheGround) {
  expect_one(
      faults_of(stone("-0.35", "")),
      {"w.sdf:", "include[stone]", "0.35 m",
       "link 'rock' starts with its centre that far below the ground", "raise it by its <pose>"});
}

TEST(StartCheck, NamesAWheelThatStartsBelowTheGround) {
  // The wheels' centres are 0.525 m up; the chassis stays above the ground.
  expect_one(faults_of(digger("-0.8")),
             {"w.sdf:", "include[digger]", "0.2", "wheel '", "navvy:on_ground"});
}

TEST(StartCheck, AllowsBodiesInTheGroundToTheirMiddleAndSunkenMachines) {
  EXPECT_TRUE(faults_of(stone("-0.01", "")).empty());
  EXPECT_TRUE(faults_of(digger("-0.1")).empty());
}

TEST(StartCheck, AllowsStaticAndScriptedModelsInTheGround) {
  EXPECT_TRUE(faults_of(stone("-0.35", "<static>true</static>")).empty());
  EXPECT_TRUE(faults_of(stone("-0.35", "<navvy:physics>kinematic</navvy:physics>")).empty());
}

TEST(StartCheck, AllowsBodiesThatStandStillToOverlapEachOtherOnly) {
  const auto two = [](const std::string& first, const std::string& second) {
    std::string other = stone("1", second);
    other.replace(other.find("stone"), 5, "other");
    return faults_of(stone("1", first) + other);
  };
  EXPECT_TRUE(two("<static>true</static>", "<static>true</static>").empty());
  expect_one(two("<static>true</static>", ""), {"include[other]", "it overlaps 'stone'"});
}

TEST(StartCheck, NamesAnEyeOutOfReachAndAllowsHitchedMachinesToOverlap) {
  const auto train = [](const std::string& x, const std::string& closed) {
    return "<include><uri>model://robot</uri><name>robot</name></include><include><uri>model://"
           "robot_trailer</uri>"
           "<name>trailer</name><pose>" +
           x +
           " 0 0 0 0 0</pose></include><navvy:hitch name=\"tow\"><parent>robot::chassis</parent>"
           "<child>trailer::chassis</child><hook_m>-0.1 0 0.15</hook_m><eye_m>0.6 0 0.15</eye_m>" +
           closed + "</navvy:hitch>";
  };
  // The drawbar extends 0.3 m into the robot, where its hook is.
  EXPECT_TRUE(faults_of(train("-0.7", "")).empty());
  expect_one(faults_of(train("-1.2", "")),
             {"w.sdf:", "navvy:hitch[tow]", "within 0.1 m of the hook", "0.500", "trailer"});
  EXPECT_TRUE(faults_of(train("-1.2", "<closed>false</closed>")).empty());
}

/// Returns a cube with edges of 0.3 m and this inertia [kg m2].
std::string cube(const std::string& name, const std::string& height, const std::string& mass,
                 const std::string& inertia) {
  return "<model name=\"" + name + "\"><pose>0 0 " + height +
         " 0 0 0</pose><navvy:on_ground>false</navvy:on_ground><link name=\"b\"><inertial><mass>" +
         mass + "</mass><inertia><ixx>" + inertia + "</ixx><iyy>" + inertia + "</iyy><izz>" +
         inertia +
         "</izz></inertia></inertial><collision name=\"c\"><geometry><box><size>0.3 0.3 0.3"
         "</size></box></geometry></collision></link></model>";
}

TEST(StartCheck, WarnsOfAnInertiaThatDoesNotFitTheShape) {
  // 10 kg: 0.15 kg m2.
  EXPECT_TRUE(faults_of(cube("c", "0.5", "10", "0.002")).empty());
  expect_one(faults_of(cube("c", "0.5", "10", "0.0014")),
             {"w.sdf:", "include[c]", "0.0014 kg m2", "its link 'b'", "0.93 %", "0.15 kg m2",
              "correct <inertia>"},
             Fault::Severity::kWarning);
}

TEST(StartCheck, WarnsOfATooHeavyBodyOnAnother) {
  const std::string light = cube("light", "0.15", "10", "0.15");
  EXPECT_TRUE(faults_of(light + cube("heavy", "0.45", "1990", "30")).empty());
  expect_one(faults_of(light + cube("heavy", "0.45", "2010", "30")),
             {"w.sdf:", "include[heavy]", "2010 kg", "rests on 'light' of 10 kg", "201",
              "sink into each other"},
             Fault::Severity::kWarning);
  // Beside it, or the light one above: nothing rests on it.
  EXPECT_TRUE(faults_of(light + cube("heavy", "1.5", "2010", "30")).empty());
  EXPECT_TRUE(
      faults_of(cube("light", "0.45", "10", "0.15") + cube("heavy", "0.15", "2010", "30")).empty());
}

TEST(StartCheck, AcceptsShippedScenes) {
  int scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(navvy::source_dir() + "/scenarios")) {
    if (entry.path().extension() != ".sdf") continue;
    const scene::Scene scene = testing::load(entry.path().filename().string());
    const heightfield::Ground ground = heightfield::make_ground(scene, nullptr);
    for (const Fault& fault : check_buried(scene, starting_poses(scene, ground), ground))
      ADD_FAILURE() << fault.text();
    for (const Fault& fault : check_bodies(scene, starting_poses(scene, ground)))
      ADD_FAILURE() << fault.text();
    ++scenes;
  }
  EXPECT_GE(scenes, 7);
}

/// Returns a body of 40 kg on four legs of 0.4 m, on hinges that hold, at this height of its feet.
std::string walker(const std::string& height) {
  std::string out = "<model name=\"walker\"><pose>0 0 " + height +
                    " 0 0 0</pose><navvy:on_ground>false</navvy:on_ground><link name=\"body\">"
                    "<pose>0 0 0.45 0 0 0</pose><navvy:density_kg_per_m3>500"
                    "</navvy:density_kg_per_m3><collision name=\"c\"><geometry><box><size>0.8 0.5 "
                    "0.2</size></box></geometry></collision></link>";
  for (const char* place : {"0.35 0.2", "0.35 -0.2", "-0.35 0.2", "-0.35 -0.2"}) {
    const std::string name = "leg" + std::to_string(out.size());
    out += "<link name=\"" + name + "\"><pose>" + place +
           " 0.2 0 0 0</pose><navvy:density_kg_per_m3>500</navvy:density_kg_per_m3><collision "
           "name=\"c\"><geometry><box><size>0.08 0.08 0.4</size></box></geometry></collision>"
           "</link><joint name=\"j" +
           name + "\" type=\"revolute\"><pose>0 0 0.2 0 0 0</pose><parent>body</parent><child>" +
           name + "</child><axis><xyz>0 1 0</xyz></axis></joint>";
  }
  return out + "</model>";
}

TEST(StartCheck, ReportsHowAMachineWithoutWheelsStands) {
  const StartCheck start = check_start(scene_io::load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil ref=\"loam\"/>"
      "<navvy:ground><size_m>24 20</size_m></navvy:ground>" +
          walker("0") + "</world></sdf>",
      "w.sdf", control::step_kinds()));
  ASSERT_EQ(start.without_wheels.size(), 1u);
  EXPECT_TRUE(start.faults.empty());
  EXPECT_NE(start.without_wheels[0].find("stands without wheels: after a second its base is 0.00"),
            std::string::npos)
      << start.without_wheels[0];
}

TEST(StartCheck, WarnsOfAMachineThatIsThrownUp) {
  // Its feet reach 0.15 m into the ground, which pushes them out.
  expect_one(faults_of(walker("-0.15")),
             {"w.sdf:", "include[walker]", "thrown up by that much", "overlap the ground"},
             Fault::Severity::kWarning);
}

}  // namespace
}  // namespace navvy::sim
