// SPDX-License-Identifier: Apache-2.0
// Small scenes with sensors.
#pragma once

#include <memory>
#include <string>

#include "control/step_kinds.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "sensor/make_sensors.h"
#include "sim/world.h"

namespace navvy::sensor::testing {

/// Returns a site of 20 m x 20 m whose middle is the origin and whose surface is at z = 0, with the
/// elements `inside` of a world, and shapes of the ground.
inline scene::Scene scene_of(const std::string& inside, const std::string& ground = "") {
  return scene_io::load_scene_from_string(R"(<sdf version="1.9" xmlns:navvy="navvy">
<world name="w"><navvy:soil ref="loam"/>
<navvy:ground><size_m>20 20</size_m><depth_m>2</depth_m>)" +
                                              ground + "</navvy:ground>" + inside +
                                              "</world></sdf>",
                                          "test.sdf", control::step_kinds());
}

/// Returns a body that stands still at `pose` and looks like `geometry`, with elements of its link.
inline std::string body(const std::string& name, const std::string& pose,
                        const std::string& geometry, const std::string& link = "") {
  return "<model name=\"" + name + "\"><static>true</static><navvy:on_ground>false" +
         "</navvy:on_ground><pose>" + pose + "</pose><link name=\"base\"><visual name=\"v\">" +
         "<geometry>" + geometry + "</geometry></visual>" + link + "</link></model>";
}

/// Returns a mast of 0.2 m at the origin; its link has the elements `sensors`.
inline std::string mast(const std::string& sensors) {
  return body("mast", "0 0 0.1 0 0 0", "<box><size>0.2 0.2 0.2</size></box>", sensors);
}

/// Returns a laser scanner named "laser" at `pose` in its link. `more` are elements of the sensor,
/// `of_lidar` those of its <lidar>.
inline std::string laser(const std::string& pose, int samples, double half_angle,
                         const std::string& more = "", const std::string& of_lidar = "",
                         const std::string& name = "laser") {
  return "<sensor name=\"" + name + "\" type=\"lidar\"><pose>" + pose +
         "</pose><update_rate>50</update_rate>" + more + "<lidar><scan><horizontal><samples>" +
         std::to_string(samples) + "</samples><min_angle>" + std::to_string(-half_angle) +
         "</min_angle><max_angle>" + std::to_string(half_angle) +
         "</max_angle></horizontal></scan><range><min>0.05</min><max>15</max></range>" + of_lidar +
         "</lidar></sensor>";
}

/// Returns a world with its sensors.
inline std::unique_ptr<sim::World> world_of(const scene::Scene& scene, device::Device& device,
                                            bool with_sensors = true) {
  auto world = std::make_unique<sim::World>(scene, device);
  if (with_sensors)
    for (auto& one : make_sensors(*world)) world->add(std::move(one));
  return world;
}

}  // namespace navvy::sensor::testing
