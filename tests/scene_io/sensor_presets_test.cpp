// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <variant>

#include "control/step_kinds.h"
#include "folder.h"
#include "paths.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

/// Loads a world of 20 m x 20 m with these elements.
scene::Scene load(const std::string& body) {
  return load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil ref=\"loam\"/>"
      "<navvy:ground><size_m>20 20</size_m></navvy:ground>" +
          body + "</world></sdf>",
      // Named only, never written.
      source_dir() + "/scenarios/mine.sdf", control::step_kinds());
}

TEST(SensorPresets, FillInASensorAndOtherSensorsOfSdfAreIgnored) {
  const scene::Scene world = load(R"(<model name="m"><static>true</static><link name="l">
      <sensor name="eye" type="thermal_camera"><camera/></sensor>
      <sensor name="laser"><navvy:preset>sick_lms200</navvy:preset><pose degrees="true">0 0 1 0 0 90
      </pose><update_rate>25</update_rate><lidar><range><max>6</max></range></lidar></sensor>
      </link></model>)");
  ASSERT_EQ(world.machines[0].machine.links[0].sensors.size(), 1u);
  const scene::Sensor& sensor = world.machines[0].machine.links[0].sensors[0];
  EXPECT_EQ(sensor.type, "lidar");
  // Its own elements go before those of the preset.
  EXPECT_EQ(sensor.rate, 25);
  EXPECT_NEAR(sensor.X_LS.linear()(1, 0), 1, 1e-12);
  const auto& lidar = std::get<scene::Lidar>(sensor.kind);
  EXPECT_EQ(lidar.horizontal.samples, 361);
  EXPECT_EQ(lidar.range.max, 6);
  EXPECT_EQ(lidar.range.resolution, 0.001);
  EXPECT_EQ(lidar.noise.type, "gaussian");
  EXPECT_EQ(lidar.noise.stddev, 0.005);
}

TEST(SensorPresets, HaveTheFansOfTheirDataSheets) {
  const auto laser = [](const std::string& preset) {
    const scene::Scene world = load(
        "<model name=\"m\"><static>true</static><link name=\"l\"><sensor "
        "name=\"s\"><navvy:preset>" +
        preset + "</navvy:preset></sensor></link></model>");
    return std::get<scene::Lidar>(world.machines[0].machine.links[0].sensors.at(0).kind);
  };
  const scene::Lidar lms = laser("sick_lms5xx"), rings = laser("spinning_128");
  EXPECT_EQ(lms.vertical.samples, 1);
  EXPECT_GT(lms.horizontal.samples, 361);
  EXPECT_EQ(rings.vertical.samples, 128);
  EXPECT_EQ(rings.horizontal.samples, 1024);
  EXPECT_GT(rings.sweep, 0) << "it measures column by column";
}

TEST(SensorPresets, ASecondSensorOfAKindIsOneFileAndOneRowOfTheScene) {
  const test::Folder folder;
  std::ofstream(folder / "own.sdf")
      << R"(<sdf version="1.9"><sensor name="own" type="lidar"><update_rate>20</update_rate><lidar>
      <scan><horizontal><samples>5</samples><min_angle>-1</min_angle><max_angle>1</max_angle>
      </horizontal></scan><range><min>0.1</min><max>7</max></range></lidar></sensor></sdf>)";
  const scene::Scene world =
      load(R"(<include><uri>model://robot</uri>
      <pose>0 0 0 0 0 0</pose>
      <navvy:sensor name="laser" link="chassis"><navvy:preset>paper_laser</navvy:preset></navvy:sensor>
      <navvy:sensor name="own" link="chassis"><navvy:preset>)" +
           std::string(folder / "own.sdf") + "</navvy:preset></navvy:sensor></include>");
  const scene::Machine& robot = world.machines[0].machine;
  const auto& sensors = robot.links[static_cast<std::size_t>(robot.link_index("chassis"))].sensors;
  ASSERT_EQ(sensors.size(), 2u);
  EXPECT_EQ(sensors[1].rate, 20);
  EXPECT_EQ(std::get<scene::Lidar>(sensors[1].kind).horizontal.samples, 5);
  EXPECT_EQ(std::get<scene::Lidar>(sensors[1].kind).range.max, 7);
}

TEST(SensorPresets, StandInASceneAndMoveToTheirLinks) {
  const scene::Scene world = load(R"(<include><uri>model://robot</uri><pose>0 0 0 0 0 0</pose>
      <navvy:sensor name="laser" link="chassis"><navvy:preset>paper_laser</navvy:preset>
      <pose>0.14 0 0.31 0 0 0</pose></navvy:sensor></include>)");
  const scene::Machine& robot = world.machines[0].machine;
  const auto index = static_cast<std::size_t>(robot.link_index("chassis"));
  ASSERT_EQ(robot.links[index].sensors.size(), 1u);
  EXPECT_EQ(std::get<scene::Lidar>(robot.links[index].sensors[0].kind).range.max, 20);
  EXPECT_TRUE(robot.has_sensors());
}

}  // namespace
}  // namespace navvy::scene_io
