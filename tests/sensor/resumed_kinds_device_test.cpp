// SPDX-License-Identifier: Apache-2.0
// Every kind of sensor goes on from a snapshot as if there had been none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "core/saved_state.h"
#include "sensor/digging_bucket.h"
#include "sensor/scenes.h"
#include "session/session.h"

namespace navvy::sensor {
namespace {

using testing::digging_bucket;
using testing::scene_of;

/// Returns a sensor with errors, a latency of its own, and a rate at which the snapshot is between
/// two readings.
std::string sensor(const std::string& name, const std::string& type, const std::string& link,
                   const std::string& inside, const std::string& pose = "0 0 0 0 0 0") {
  return "<navvy:sensor name=\"" + name + "\" link=\"" + link + "\" type=\"" + type + "\"><pose>" +
         pose + "</pose><update_rate>17</update_rate><navvy:latency_s>0.03</navvy:latency_s>" +
         inside + "</navvy:sensor>\n";
}

/// Returns a noise whose bias drifts, so that every reading depends on those before it. `name` is
/// that of its element.
std::string noise(const std::string& size, const std::string& name = "noise") {
  return "<" + name + "><type>gaussian</type><stddev>" + size + "</stddev><bias_stddev>" + size +
         "</bias_stddev><dynamic_bias_stddev>" + size +
         "</dynamic_bias_stddev><dynamic_bias_correlation_time>0.5"
         "</dynamic_bias_correlation_time></" +
         name + ">";
}

/// Returns the sensors of a digging bucket: all kinds but those of cylinders and contacts.
std::string sensors_of_bucket() {
  const std::string behind = "-3 0 2.2 0 0.6 0";
  const std::string picture = "<camera><image><width>24</width><height>16</height></image>";
  return sensor("lidar", "lidar", "base",
                "<navvy:sweep_s>0.04</navvy:sweep_s><lidar><scan><horizontal><samples>61</samples>"
                "<min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal></scan>" +
                    noise("0.01") + "</lidar><navvy:drop_share>0.1</navvy:drop_share>",
                behind) +
         sensor("sonar", "sonar", "base",
                "<sonar><max>6</max></sonar>" + noise("0.01", "navvy:noise"), behind) +
         sensor("infrared", "navvy:infrared", "base",
                "<navvy:infrared><range><max>8</max></range><spot_deg>2</spot_deg>" +
                    noise("0.01") + "</navvy:infrared>",
                behind) +
         sensor("pmd", "navvy:time_of_flight", "base",
                "<navvy:time_of_flight><width>16</width><height>12</height>" + noise("0.01") +
                    "</navvy:time_of_flight>",
                behind) +
         sensor("imu", "imu", "bucket",
                "<imu><angular_velocity><x>" + noise("0.01") +
                    "</x></angular_velocity><linear_acceleration><z>" + noise("0.1") +
                    "</z></linear_acceleration></imu>") +
         sensor("gnss", "navsat", "lift",
                "<navsat><position_sensing><horizontal>" + noise("0.02") +
                    "</horizontal></position_sensing></navsat>",
                "0 0 1 0 0 0") +
         sensor("joint", "navvy:joint", "lift",
                "<navvy:joint><joint>slide_x</joint><position>" + noise("0.001") +
                    "</position></navvy:joint>") +
         sensor("tip", "navvy:tool_force", "bucket",
                "<navvy:tool_force><shell>bucket</shell>" + noise("10") + "</navvy:tool_force>") +
         sensor("scale", "navvy:payload", "bucket",
                "<navvy:payload><shell>bucket</shell><scale_error>0.02</scale_error>" + noise("1") +
                    "</navvy:payload>") +
         sensor("depth", "depth_camera", "base", picture + noise("0.01") + "</camera>", behind) +
         sensor("labels", "segmentation", "base", picture + "</camera>", behind) +
         sensor("eye", "camera", "base", picture + noise("0.02") + "</camera>", behind) +
         sensor("pair", "navvy:stereo", "base", picture + noise("0.02") + "</camera>", behind) +
         sensor("map", "navvy:map", "base", "");
}

/// Returns a scene with a sensor of every kind: a bucket that digs, an excavator that stands with a
/// gauge on a cylinder, and a body that lies on a plate with a contact switch.
scene::Scene all_kinds() {
  const std::string box = "<geometry><box><size>0.6 0.6 0.3</size></box></geometry>";
  return scene_of(
      digging_bucket(sensors_of_bucket()) +
      "<include><uri>model://ew180</uri><name>digger</name><pose>-4 6 0 0 0 0</pose>" +
      sensor("pressure", "navvy:cylinder", "boom",
             "<navvy:cylinder><cylinder>boom_cylinder</cylinder>" + noise("1000") +
                 "</navvy:cylinder>") +
      "</include><model name=\"plate\"><static>true</static><navvy:on_ground>false"
      "</navvy:on_ground><pose>6 -6 0.15 0 0 0</pose><link name=\"base\"><collision name=\"c\">" +
      box +
      "</collision><sensor name=\"switch\" type=\"contact\"><update_rate>17</update_rate>"
      "</sensor></link></model><model name=\"stone\"><navvy:on_ground>false</navvy:on_ground>"
      "<pose>6 -6 0.46 0 0 0</pose><link name=\"b\"><navvy:density_kg_per_m3>2600"
      "</navvy:density_kg_per_m3><collision name=\"c\">" +
      box + "</collision></link></model>");
}

std::unique_ptr<session::Session> started(device::Device& device) {
  auto out = std::make_unique<session::Session>(all_kinds(), device);
  for (auto& one : make_sensors(out->world())) out->add(std::move(one));
  return out;
}

void run_to(session::Session& session, double time) {
  while (session.world().time() < time - 1e-9) session.step();
}

TEST(ResumedSensors, OfEveryKindGiveTheReadingsOfTheWholeRun) {
  device::Device device;
  const auto whole = started(device);
  const sim::World& world = whole->world();
  std::set<std::size_t> kinds;
  for (const scene::MachineInWorld& placed : world.description().machines)
    for (const scene::Link& link : placed.machine.links)
      for (const scene::Sensor& one : link.sensors) kinds.insert(one.kind.index());
  ASSERT_EQ(kinds.size(), std::variant_size_v<scene::SensorKind>) << "a kind has no sensor here";

  // In the middle of a sweep, while readings are on their way, with soil in the bucket.
  run_to(*whole, 2.02);
  const std::vector<char> state = saved(*whole);
  const auto resumed = started(device);
  load_saved(state, *resumed);
  std::vector<std::uint64_t> before;
  const std::size_t count = world.arrays().channels().size();
  for (std::size_t i = 0; i < count; ++i)
    before.push_back(world.arrays().view(static_cast<int>(i)).sequence());
  run_to(*whole, 2.2);
  run_to(*resumed, 2.2);
  for (std::size_t i = 0; i < count; ++i) {
    const sim::ArrayView one = world.arrays().view(static_cast<int>(i)),
                         other = resumed->world().arrays().view(static_cast<int>(i));
    const std::string& name = one.channel().name;
    EXPECT_GT(one.sequence(), before[i]) << name << " has no reading after the snapshot";
    EXPECT_EQ(one.sequence(), other.sequence()) << name;
    EXPECT_EQ(one.time(), other.time()) << name;
    EXPECT_TRUE(std::equal(one.bytes().begin(), one.bytes().end(), other.bytes().begin(),
                           other.bytes().end()))
        << name;
  }
}

}  // namespace
}  // namespace navvy::sensor
