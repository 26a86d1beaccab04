// SPDX-License-Identifier: Apache-2.0
// What all sensors have in common, and the kinds that do not look.
#include "sensor/sensor_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/saved_state.h"
#include "sensor/scenes.h"
#include "sensor/sensor_output.h"

namespace navvy::sensor {
namespace {

using testing::body;
using testing::laser;
using testing::mast;
using testing::scene_of;
using testing::world_of;

const char* const kNoisy =
    "<noise><type>gaussian</type><stddev>0.01</stddev><bias_stddev>0.02</bias_stddev></noise>";

/// Returns a kinematic robot that carries `sensors` (of an <include>) and heads for a wall whose
/// face is at x = 6.
std::string robot_before_wall(const std::string& sensors) {
  return "<include><uri>model://robot</uri><name>robot</name><pose>-2 0 0 0 0 0</pose>"
         "<navvy:physics>kinematic</navvy:physics>" +
         sensors + "</include>" + body("wall", "6.5 0 1 0 0 0", "<box><size>1 12 2</size></box>");
}

std::string robot_laser(const std::string& name, const std::string& more,
                        const std::string& of_lidar = "", int samples = 21) {
  std::string text = laser("0.14 0 0.31 0 0 0", samples, 0.1, more, of_lidar, name);
  text.replace(0, 7, "<navvy:sensor link=\"chassis\"");
  text.replace(text.rfind("</sensor>"), 9, "</navvy:sensor>");
  return text;
}

class SensorTest : public ::testing::Test {
 protected:
  std::unique_ptr<sim::World> rolling(const std::string& sensors, bool with_sensors = true) {
    auto world = world_of(scene_of(robot_before_wall(sensors)), device_, with_sensors);
    world->commands().set(world->machines().at("robot"), {1.0, 0, false});
    return world;
  }
  static void run_to(sim::World& world, double time) {
    while (world.time() < time - 0.5 * world.dt()) world.step();
  }
  static std::vector<std::byte> bytes(const sim::World& world, const std::string& name) {
    const auto view = world.arrays().view(name);
    return {view.bytes().begin(), view.bytes().end()};
  }
  device::Device device_;
};

TEST_F(SensorTest, ChangesNothingInTheStateHash) {
  const std::string noisy = robot_laser("laser", "", kNoisy);
  const auto with = rolling(noisy), without = rolling(noisy, false);
  run_to(*with, 0.2);
  run_to(*without, 0.2);
  EXPECT_GT(with->arrays().view("robot/laser/ranges").sequence(), 5u);
  EXPECT_EQ(with->hashes().state(), without->hashes().state());
  // Nor do sensors belong to the parameters of a scene.
  EXPECT_EQ(with->hashes().start(), rolling("")->hashes().start());
}

TEST_F(SensorTest, DrawsItsOwnNumbersFromSeedAndName) {
  const auto one = rolling(robot_laser("laser", "", kNoisy));
  const auto two = rolling(robot_laser("other", "", kNoisy) + robot_laser("laser", "", kNoisy));
  run_to(*one, 0.1);
  run_to(*two, 0.1);
  EXPECT_EQ(bytes(*one, "robot/laser/ranges"), bytes(*two, "robot/laser/ranges"));
  EXPECT_NE(bytes(*two, "robot/other/ranges"), bytes(*two, "robot/laser/ranges"));
}

TEST_F(SensorTest, ResumesToTheSameReadings) {
  const std::string sensors =
      robot_laser("laser",
                  "<navvy:latency_s>0.013</navvy:latency_s><navvy:sweep_s>0.015"
                  "</navvy:sweep_s><navvy:drop_share>0.1</navvy:drop_share>",
                  kNoisy);
  const auto whole = rolling(sensors);
  // In the middle of a sweep, while the reading before it is on its way.
  run_to(*whole, 0.105);
  const std::vector<char> state = saved(*whole);
  run_to(*whole, 0.3);
  const auto resumed = rolling(sensors);
  load_saved(state, *resumed);
  run_to(*resumed, 0.3);
  EXPECT_EQ(bytes(*resumed, "robot/laser/ranges"), bytes(*whole, "robot/laser/ranges"));
  EXPECT_EQ(resumed->arrays().view("robot/laser/ranges").sequence(),
            whole->arrays().view("robot/laser/ranges").sequence());
}

TEST_F(SensorTest, DeliversAfterItsLatencyWithTheStampOfTheMeasurement) {
  const auto world = rolling(robot_laser("laser", "<navvy:latency_s>0.05</navvy:latency_s>"));
  EXPECT_EQ(world->arrays().view("robot/laser/ranges").sequence(), 0u);
  run_to(*world, 0.5);
  const auto view = world->arrays().view("robot/laser/ranges");
  EXPECT_GE(view.delivered() - view.time(), 0.05 - 1e-9);
  EXPECT_LE(view.delivered() - view.time(), 0.05 + world->dt());
  EXPECT_EQ(world->outputs().get("robot/laser/readings"), static_cast<double>(view.sequence()));
  // The distance is that of the stamp, not of the delivery.
  const float middle = view.values<float>()[10];
  EXPECT_NEAR(middle, 6 - view.X_WF().translation().x(), 1e-4);
}

TEST_F(SensorTest, SweepsWhileItMoves) {
  // Five beams straight ahead, one after the other, from a robot that drives at 1 m/s.
  std::string sensor = robot_laser("laser", "<navvy:sweep_s>0.02</navvy:sweep_s>", "", 5);
  for (const char* angle : {"<min_angle>-0.1", "<max_angle>0.1"}) {
    const std::size_t at = sensor.find(angle);
    sensor.replace(at, sensor.find("</", at) - at, std::string(angle).substr(0, 11) + "0");
  }
  const auto world = rolling(sensor);
  run_to(*world, 0.61);
  const auto view = world->arrays().view("robot/laser/ranges");
  const auto read = view.values<float>();
  const double v = world->machines().at("robot").link(0).velocity().x();
  ASSERT_GT(v, 0.5);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(read[i], 6 - view.X_WF().translation().x() - v * 0.005 * static_cast<double>(i),
                2e-4)
        << i;
}

TEST_F(SensorTest, SweepsOverABodyThatMoves) {
  // Beams straight ahead, one after the other, on a box that a slide moves towards a laser at 2
  // m/s.
  constexpr int kBeams = 9;
  constexpr double kSweep = 0.018, kSpeed = 2, kHalf = 0.5;
  const std::string slide = R"(<model name="slide"><navvy:physics>kinematic</navvy:physics>
<static>true</static><navvy:on_ground>false</navvy:on_ground><pose>8 0 0.1 0 0 0</pose>
<link name="base"><visual name="v"><geometry><box><size>0.1 0.1 0.1</size></box></geometry></visual></link>
<link name="box"><pose>0 0 0.9 0 0 0</pose>
<visual name="v"><geometry><box><size>1 1 1</size></box></geometry></visual></link>
<joint name="x" type="prismatic"><parent>base</parent><child>box</child><axis><xyz>1 0 0</xyz>
<limit><lower>-6</lower><upper>6</upper><velocity>5</velocity></limit></axis></joint></model>)";
  const auto world = world_of(
      scene_of(mast(laser("0 0 0.9 0 0 0", kBeams, 0,
                          "<navvy:sweep_s>" + std::to_string(kSweep) + "</navvy:sweep_s>")) +
               slide),
      device_);
  const sim::MachineHandle machine = world->machines().at("slide");
  world->commands().set(machine.joint("x"), {vehicle::JointMode::kVelocity, -kSpeed});
  // Ends of the steps, and where the face of the box is then.
  std::vector<double> times, faces;
  times.reserve(10000);
  faces.reserve(10000);
  const auto view = [&] { return world->arrays().view("mast/laser/ranges"); };
  while (view().time() < 0.5) {
    world->step();
    times.push_back(world->time());
    faces.push_back(machine.link("box").pose().translation().x() - kHalf);
  }
  ASSERT_LT(machine.link("box").velocity().x(), -0.99 * kSpeed);
  const auto read = view().values<float>();
  for (int i = 0; i < kBeams; ++i) {
    // The world is as it is at the end of the step around the beam's instant.
    const double t = view().time() + kSweep * i / (kBeams - 1);
    const auto end = std::lower_bound(times.begin(), times.end(), t - 1e-9);
    ASSERT_NE(end, times.end());
    const double face = faces[static_cast<std::size_t>(end - times.begin())];
    EXPECT_NEAR(read[static_cast<std::size_t>(i)], face, 2e-4) << i;
  }
  // From the first to the last beam the box has come nearer, within a step.
  EXPECT_NEAR(read[0] - read[kBeams - 1], kSpeed * kSweep, kSpeed * world->dt());
}

TEST_F(SensorTest, BeamsHaveTheMeanAndTheDeviationOfTheirNoise) {
  // 1000 beams straight ahead on a wall at 4 m, 100 times.
  constexpr int kBeams = 1000, kScans = 100;
  const std::string noise =
      "<noise><type>gaussian</type><mean>0.05</mean><stddev>0.02</stddev></noise>";
  const auto world =
      world_of(scene_of(mast(laser("0 0 0.9 0 0 0", kBeams, 0, "", noise)) +
                        body("wall", "4.5 0 1 0 0 0", "<box><size>1 4 2</size></box>")),
               device_);
  double sum = 0, squares = 0;
  std::uint64_t scans = 0;
  while (scans < kScans) {
    const auto view = world->arrays().view("mast/laser/ranges");
    if (view.sequence() > scans) {
      ASSERT_EQ(view.sequence(), ++scans);
      for (const float read : view.values<float>()) {
        const double error = static_cast<double>(read) - 4;
        sum += error;
        squares += error * error;
      }
    }
    world->step();
  }
  constexpr int kReadings = kBeams * kScans;
  const double mean = sum / kReadings, sigma = std::sqrt(squares / kReadings - mean * mean);
  EXPECT_NEAR(mean, 0.05, 0.02 * 0.05);
  EXPECT_NEAR(sigma, 0.02, 0.02 * 0.02);
}

TEST_F(SensorTest, ListsItsArraysWithKindAndFrames) {
  const auto world = rolling(robot_laser("laser", ""));
  const std::vector<SensorOutput> all = sensor_outputs(*world);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].name, "robot/laser");
  EXPECT_EQ(all[0].link_name, "robot/chassis");
  EXPECT_EQ(all[0].description->type, "lidar");
  ASSERT_EQ(all[0].arrays.size(), 1u);
  const auto view = world->arrays().view(all[0].arrays[0].index);
  EXPECT_EQ(view.channel().name, "robot/laser/ranges");
  EXPECT_EQ(view.channel().rate, 50);
}

TEST_F(SensorTest, InfraredMeasuresTheMeanDistanceOverItsSpot) {
  const std::string sensor =
      "<sensor name=\"infrared\" type=\"navvy:infrared\"><pose>0 0 0.9 0 0 0</pose><update_rate>20"
      "</update_rate><navvy:infrared><range><min>0.1</min><max>3</max></range><spot_deg>2</"
      "spot_deg>"
      "</navvy:infrared></sensor>";
  const auto read = [&](double x) {
    const auto world =
        world_of(scene_of(mast(sensor) + body("wall", std::to_string(x) + " 0 1 0 0 0",
                                              "<box><size>1 4 2</size></box>")),
                 device_);
    return world->arrays().view("mast/infrared/range").values<float>()[0];
  };
  EXPECT_NEAR(read(2), 1.5, 0.002);
  EXPECT_EQ(read(5), std::numeric_limits<float>::infinity()) << "beyond its range";
}

TEST_F(SensorTest, UltrasoundReturnsTheFirstEchoInItsCone) {
  const std::string sonar =
      "<sensor name=\"sonar\" type=\"sonar\"><pose>0 0 1.4 0 0 0</pose><update_rate>20"
      "</update_rate><sonar><min>0.2</min><max>5</max><radius>1.34</radius></sonar></sensor>";
  // A post beside the axis, inside the cone of 15 deg; the cone would meet the ground at 5.8 m.
  const auto world = world_of(
      scene_of(mast(sonar) + body("post", "3 0.5 1.5 0 0 0",
                                  "<cylinder><radius>0.1</radius><length>3</length></cylinder>")),
      device_);
  const float read = world->arrays().view("mast/sonar/range").values<float>()[0];
  EXPECT_NEAR(read, std::hypot(3, 0.5) - 0.1, 0.02);
}

TEST_F(SensorTest, UltrasoundHearsNothingBesideItsCone) {
  // Half the cone is 10 deg.
  const std::string sonar =
      "<sensor name=\"sonar\" type=\"sonar\"><pose>0 0 1.4 0 0 0</pose><update_rate>20"
      "</update_rate><sonar><min>0.2</min><max>5</max><radius>0.882</radius></sonar></sensor>";
  const auto read = [&](double aside_deg) {
    const double a = radians(aside_deg);
    const auto world = world_of(
        scene_of(mast(sonar) + body("post",
                                    std::to_string(3 * std::cos(a)) + " " +
                                        std::to_string(3 * std::sin(a)) + " 1.5 0 0 0",
                                    "<cylinder><radius>0.1</radius><length>3</length></cylinder>")),
        device_);
    return world->arrays().view("mast/sonar/range").values<float>()[0];
  };
  EXPECT_NEAR(read(5), 2.9, 0.02);
  EXPECT_EQ(read(20), std::numeric_limits<float>::infinity());
  EXPECT_EQ(read(-20), std::numeric_limits<float>::infinity());
}

TEST_F(SensorTest, InertialUnitAtRestFeelsGravity) {
  const auto world = world_of(
      scene_of(mast("<sensor name=\"imu\" type=\"imu\"><pose>0 0 0 0 1.5707963267948966 0</pose>"
                    "<update_rate>100</update_rate><imu/></sensor>")),
      device_);
  run_to(*world, 0.05);
  const auto force = world->arrays().view("mast/imu/linear_acceleration").values<double>();
  // Pitched by 90 deg, x points down.
  EXPECT_NEAR(force[0], -9.81, 1e-9);
  EXPECT_NEAR(force[2], 0, 1e-9);
  EXPECT_EQ(world->arrays().view("mast/imu/angular_velocity").values<double>()[1], 0);
}

TEST_F(SensorTest, InertialUnitOnATurntableFeelsItsLeverArm) {
  const std::string turntable = R"(<model name="table"><navvy:physics>kinematic</navvy:physics>
<static>true</static><pose>0 0 0 0 0 0</pose>
<link name="base"><visual name="v"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></visual></link>
<link name="disc"><pose>0 0 0.5 0 0 0</pose>
<visual name="v"><geometry><cylinder><radius>1</radius><length>0.1</length></cylinder></geometry></visual>
<sensor name="imu" type="imu"><pose>0.8 0 0.2 0 0 0</pose><update_rate>100</update_rate><imu/></sensor></link>
<joint name="turn" type="revolute"><parent>base</parent><child>disc</child><axis><xyz>0 0 1</xyz>
<limit><velocity>5</velocity></limit></axis></joint></model>)";
  const auto world = world_of(scene_of(turntable), device_);
  world->commands().set(world->machines().at("table").joint("turn"),
                        {vehicle::JointMode::kVelocity, 2});
  run_to(*world, 1);
  const auto force = world->arrays().view("table/imu/linear_acceleration").values<double>();
  const auto rate = world->arrays().view("table/imu/angular_velocity").values<double>();
  EXPECT_NEAR(rate[2], 2, 1e-6);
  // w^2 r towards the axis; the mean over a period of 10 ms turns it by half of 0.02 rad.
  EXPECT_NEAR(force[0], -4 * 0.8, 0.01);
  EXPECT_NEAR(force[1], 4 * 0.8 * 0.01, 0.01);
  EXPECT_NEAR(force[2], 9.81, 1e-6);
}

TEST_F(SensorTest, SatelliteReceiverLosesItsFixUnderARoof) {
  const std::string gnss =
      "<sensor name=\"gnss\" type=\"navsat\"><pose>0 0 0.5 0 0 0</pose><update_rate>10"
      "</update_rate></sensor>";
  const auto open = world_of(scene_of(mast(gnss)), device_);
  EXPECT_EQ(open->arrays().view("mast/gnss/status").values<std::int32_t>()[0], 1);
  EXPECT_EQ(open->arrays().view("mast/gnss/status").values<std::int32_t>()[1], 12);
  EXPECT_NEAR(open->arrays().view("mast/gnss/position").values<double>()[2], 0.6, 1e-9);
  const auto covered = world_of(
      scene_of(mast(gnss) + body("roof", "0 0 1 0 0 0", "<box><size>9 9 0.1</size></box>")),
      device_);
  EXPECT_EQ(covered->arrays().view("mast/gnss/status").values<std::int32_t>()[0], 0);
  EXPECT_TRUE(std::isnan(covered->arrays().view("mast/gnss/position").values<double>()[0]));
}

TEST_F(SensorTest, GaugesReadJointsAndCylinders) {
  const auto world = world_of(scene_of(R"(<include><uri>model://ew180</uri><name>digger</name>
<pose>-2 0 0 0 0 0</pose>
<navvy:sensor name="boom" link="boom" type="navvy:joint"><update_rate>100</update_rate>
<navvy:joint><joint>boom_joint</joint></navvy:joint></navvy:sensor>
<navvy:sensor name="pressure" link="boom" type="navvy:cylinder"><update_rate>100</update_rate>
<navvy:cylinder><cylinder>boom_cylinder</cylinder></navvy:cylinder></navvy:sensor>
<navvy:sensor name="scale" link="bucket" type="navvy:payload"><update_rate>10</update_rate>
<navvy:payload><shell>bucket</shell></navvy:payload></navvy:sensor>
<navvy:sensor name="tip" link="bucket" type="navvy:tool_force"><update_rate>10</update_rate>
<navvy:tool_force><shell>bucket</shell></navvy:tool_force></navvy:sensor></include>)"),
                              device_);
  run_to(*world, 0.2);
  const sim::MachineHandle digger = world->machines().at("digger");
  const vehicle::JointState joint = digger.joint("boom_joint").state();
  const auto state = world->arrays().view("digger/boom/state").values<double>();
  EXPECT_DOUBLE_EQ(state[0], joint.position);
  EXPECT_DOUBLE_EQ(state[2], joint.effort);
  const auto pressure = world->arrays().view("digger/pressure/pressure").values<double>();
  const scene::Cylinder& cylinder = digger.description().cylinders[0];
  const double head = 0.25 * kPi * cylinder.count * cylinder.bore * cylinder.bore;
  const double rod = head - 0.25 * kPi * cylinder.count * cylinder.rod * cylinder.rod;
  EXPECT_NEAR(pressure[0] * head - pressure[1] * rod, joint.cylinder_force,
              1e-9 * std::abs(joint.cylinder_force));
  EXPECT_GT(std::max(pressure[0], pressure[1]), 1e5);  // the boom is heavy
  EXPECT_DOUBLE_EQ(world->arrays().view("digger/pressure/length").values<double>()[0],
                   joint.cylinder_length);
  EXPECT_EQ(world->arrays().view("digger/scale/mass").values<double>()[0], 0);
  EXPECT_EQ(world->arrays().view("digger/tip/wrench").values<double>()[0], 0);
}

TEST_F(SensorTest, ContactSwitchClosesWhenABodyLands) {
  const std::string ball =
      "<model name=\"ball\"><navvy:on_ground>false</navvy:on_ground><pose>0 0 1 0 0 0</pose>"
      "<link name=\"b\"><inertial><mass>5</mass><inertia><ixx>0.05</ixx><iyy>0.05</iyy>"
      "<izz>0.05</izz></inertia></inertial><collision name=\"c\"><geometry><box><size>0.3 0.3 0.3"
      "</size></box></geometry></collision></link></model>";
  const std::string plate =
      body("plate", "0 0 0.25 0 0 0", "<box><size>2 2 0.5</size></box>",
           "<sensor name=\"bumper\" type=\"contact\"><update_rate>10</update_rate></sensor>");
  const auto world = world_of(scene_of(plate + ball), device_);
  EXPECT_EQ(world->arrays().view("plate/bumper/contact").values<double>()[0], 0);
  bool closed = false;
  double force = 0;
  while (world->time() < 1.5) {
    world->step();
    const auto read = world->arrays().view("plate/bumper/contact").values<double>();
    closed = closed || read[0] == 1;
    force = std::max(force, read[1]);
  }
  EXPECT_TRUE(closed);
  // More than its weight stops the fall.
  EXPECT_GT(force, 5 * 9.81);
}

}  // namespace
}  // namespace navvy::sensor
