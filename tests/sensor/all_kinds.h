// SPDX-License-Identifier: Apache-2.0
// A scene with a sensor of every kind and soil that moves.
#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "sensor/digging_bucket.h"
#include "sensor/scenes.h"

namespace navvy::sensor::testing {

/// Returns a sensor with errors, a latency of its own, and a rate at which the snapshot is between
/// two readings.
inline std::string sensor(const std::string& name, const std::string& type, const std::string& link,
                          const std::string& inside, const std::string& pose = "0 0 0 0 0 0") {
  return "<navvy:sensor name=\"" + name + "\" link=\"" + link + "\" type=\"" + type + "\"><pose>" +
         pose + "</pose><update_rate>17</update_rate><navvy:latency_s>0.03</navvy:latency_s>" +
         inside + "</navvy:sensor>\n";
}

/// Returns a noise whose bias drifts, so that every reading depends on those before it. `name` is
/// that of its element.
inline std::string noise(const std::string& size, const std::string& name = "noise") {
  return "<" + name + "><type>gaussian</type><stddev>" + size + "</stddev><bias_stddev>" + size +
         "</bias_stddev><dynamic_bias_stddev>" + size +
         "</dynamic_bias_stddev><dynamic_bias_correlation_time>0.5"
         "</dynamic_bias_correlation_time></" +
         name + ">";
}

/// Returns the sensors of a digging bucket: all kinds but those of cylinders and contacts.
inline std::string sensors_of_bucket() {
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
/// gauge on a cylinder, and a body that lies on a plate with a contact switch. The bucket has the
/// sensors `more` too.
inline scene::Scene all_kinds(const std::string& more = "") {
  const std::string box = "<geometry><box><size>0.6 0.6 0.3</size></box></geometry>";
  return scene_of(
      digging_bucket(sensors_of_bucket() + more) +
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

/// Returns the number of different kinds of sensors in a scene.
inline std::size_t kinds_in(const scene::Scene& scene) {
  std::set<std::size_t> kinds;
  for (const scene::MachineInWorld& placed : scene.machines)
    for (const scene::Link& link : placed.machine.links)
      for (const scene::Sensor& one : link.sensors) kinds.insert(one.kind.index());
  return kinds.size();
}

}  // namespace navvy::sensor::testing
