// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <variant>

#include "control/step_kinds.h"
#include "core/math.h"
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

/// Returns the shipped preset as a sensor of a body.
scene::Sensor preset(const std::string& name) {
  const scene::Scene world = load(
      "<model name=\"m\"><static>true</static><link name=\"l\"><sensor name=\"s\"><navvy:preset>" +
      name + "</navvy:preset></sensor></link></model>");
  return world.machines[0].machine.links[0].sensors.at(0);
}

/// What a data sheet says about a scanner with one ring.
struct Sheet {
  double rate;             ///< scans per second [1/s]
  int beams;               ///< number of beams
  double half_deg;         ///< largest angle to both sides [deg]
  double min, max;         ///< measured distances [m]
  double step;             ///< step of the readings [m]
  double sigma, bias;      ///< deviations of a reading and of its bias [m]
  double turns_per_s = 0;  ///< of the mirror [1/s]; 0: all beams at one instant
};

void expect_scanner(const std::string& name, const Sheet& sheet) {
  const scene::Sensor sensor = preset(name);
  EXPECT_EQ(sensor.rate, sheet.rate) << name;
  const auto& laser = std::get<scene::Lidar>(sensor.kind);
  EXPECT_EQ(laser.vertical.samples, 1) << name;
  EXPECT_EQ(laser.vertical.angle(0), 0) << name;
  EXPECT_EQ(laser.horizontal.samples, sheet.beams) << name;
  EXPECT_NEAR(laser.horizontal.min_angle, -radians(sheet.half_deg), 1e-12) << name;
  EXPECT_NEAR(laser.horizontal.max_angle, radians(sheet.half_deg), 1e-12) << name;
  // All of them have a beam every half degree.
  EXPECT_NEAR(laser.horizontal.angle(1) - laser.horizontal.angle(0), radians(0.5), 1e-12) << name;
  EXPECT_EQ(laser.range.min, sheet.min) << name;
  EXPECT_EQ(laser.range.max, sheet.max) << name;
  EXPECT_EQ(laser.range.resolution, sheet.step) << name;
  EXPECT_EQ(laser.noise.type, "gaussian") << name;
  EXPECT_EQ(laser.noise.mean, 0) << name;
  EXPECT_EQ(laser.noise.stddev, sheet.sigma) << name;
  EXPECT_EQ(laser.noise.bias_mean, 0) << name;
  EXPECT_EQ(laser.noise.bias_stddev, sheet.bias) << name;
  // The beam passes the fan at the speed of the mirror; files have three or four digits.
  const double sweep =
      sheet.turns_per_s > 0 ? 2 * sheet.half_deg / 360 / sheet.turns_per_s : laser.sweep;
  EXPECT_NEAR(laser.sweep, sweep, 5e-6) << name;
  EXPECT_EQ(laser.sweep > 0, sheet.turns_per_s > 0) << name;
}

TEST(SensorPresets, HaveTheFansOfTheirDataSheets) {
  expect_scanner("paper_laser", {25, 361, 90, 0.05, 20, 0, 0.01, 0, 0});
  expect_scanner("sick_lms200", {32, 361, 90, 0.05, 8.191, 0.001, 0.005, 0, 75});
  // Its systematic error of 25 mm counts as two sigma.
  expect_scanner("sick_lms5xx", {50, 381, 95, 0.2, 65, 0.001, 0.007, 0.0125, 50});

  const scene::Sensor spinning = preset("spinning_128");
  EXPECT_EQ(spinning.rate, 10);
  const auto& rings = std::get<scene::Lidar>(spinning.kind);
  EXPECT_EQ(rings.vertical.samples, 128);
  EXPECT_NEAR(rings.vertical.min_angle, -radians(22.5), 1e-12);
  EXPECT_NEAR(rings.vertical.max_angle, radians(22.5), 1e-12);
  EXPECT_EQ(rings.horizontal.samples, 1024);
  // A whole turn: the beam after the last one would be the first one again.
  EXPECT_NEAR(rings.horizontal.angle(1024) - rings.horizontal.angle(0), 2 * kPi, 1e-9);
  EXPECT_EQ(rings.sweep, 0.1) << "it measures column by column, all the time";
  EXPECT_EQ(rings.range.min, 0.5);
  EXPECT_EQ(rings.range.max, 100);
  EXPECT_EQ(rings.noise.type, "gaussian");
  EXPECT_EQ(rings.noise.stddev, 0.01);
}

TEST(SensorPresets, HaveTheConesSpotsAndPixelsOfTheirDataSheets) {
  const scene::Sensor pioneer = preset("pioneer_sonar");
  EXPECT_EQ(pioneer.type, "sonar");
  EXPECT_EQ(pioneer.rate, 25);
  const auto& sonar = std::get<scene::Sonar>(pioneer.kind);
  EXPECT_EQ(sonar.min, 0.15);
  EXPECT_EQ(sonar.max, 5);
  // The radius has three digits: 0.01 m at 5 m are 0.1 deg.
  EXPECT_NEAR(degrees(std::atan2(sonar.radius, sonar.max)), 15, 0.1);
  EXPECT_EQ(sonar.noise.type, "gaussian");
  EXPECT_EQ(sonar.noise.stddev, 0.02);
  EXPECT_EQ(sonar.noise.precision, 0.001);

  const scene::Sensor spot = preset("infrared");
  EXPECT_EQ(spot.type, "navvy:infrared");
  EXPECT_EQ(spot.rate, 25);
  const auto& infrared = std::get<scene::Infrared>(spot.kind);
  EXPECT_EQ(infrared.range.min, 0.1);
  EXPECT_EQ(infrared.range.max, 1.5);
  EXPECT_NEAR(degrees(infrared.spot), 2, 1e-12);
  EXPECT_EQ(infrared.noise.type, "gaussian");
  EXPECT_EQ(infrared.noise.stddev, 0.01);

  const scene::Sensor pmd = preset("pmd_camera");
  EXPECT_EQ(pmd.type, "navvy:time_of_flight");
  EXPECT_EQ(pmd.rate, 10);
  const auto& camera = std::get<scene::TimeOfFlight>(pmd.kind);
  EXPECT_EQ(camera.width, 64);
  EXPECT_EQ(camera.height, 48);
  EXPECT_NEAR(degrees(camera.fov), 40, 1e-12);
  EXPECT_EQ(camera.modulation, 20e6);
  EXPECT_EQ(camera.range.min, 0.1);
  EXPECT_EQ(camera.range.max, 12);
  EXPECT_EQ(camera.noise.type, "gaussian");
  EXPECT_EQ(camera.noise.stddev, 0.02);
}

TEST(SensorPresets, AreThoseWhoseDataSheetsAreChecked) {
  std::set<std::string> shipped;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() + "/sensors"))
    shipped.insert(entry.path().filename().string());
  EXPECT_EQ(shipped, (std::set<std::string>{"infrared.sdf", "paper_laser.sdf", "pioneer_sonar.sdf",
                                            "pmd_camera.sdf", "sick_lms200.sdf", "sick_lms5xx.sdf",
                                            "spinning_128.sdf"}));
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
