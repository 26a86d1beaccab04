// SPDX-License-Identifier: Apache-2.0
// A small scene for tests of the run loop.
#pragma once

#include <memory>
#include <string>

#include "control/step_kinds.h"
#include "paths.h"
#include "run/simulation_options.h"
#include "scene_io/loader.h"
#include "session/session.h"
#include "sim/height_grid.h"

namespace navvy::run::test {

/// Returns the shipped bucket on its path, which ends after `duration` [s] and draws no pictures.
inline scene::Scene bucket_scene(double duration, std::string* text = nullptr) {
  scene_io::Overrides overrides;
  overrides.duration = duration;
  overrides.render = false;
  return scene_io::load_scene(navvy::source_dir() + "/scenarios/bucket_path.sdf",
                              control::step_kinds(), overrides, text);
}

/// Returns the scene of `bucket_scene` with a sensor "bucket/gauge" of the joint slide_z, at 50 Hz
/// and with a latency of 5 ms.
inline scene::Scene gauged_scene(double duration) {
  scene::Scene scene = bucket_scene(duration);
  scene::Sensor gauge;
  gauge.name = "gauge";
  gauge.type = "navvy:joint";
  gauge.rate = 50;
  gauge.latency = 0.005;
  scene::JointGauge kind;
  kind.joint = "slide_z";
  gauge.kind = kind;
  scene.machines.front().machine.links.front().sensors.push_back(gauge);
  return scene;
}

/// Returns the scene of `bucket_scene` with the sensors "bucket/eye" and "bucket/labels", cameras
/// for colours and labels with 32 x 24 pixels, at 10 Hz.
inline scene::Scene scene_with_cameras(double duration) {
  scene::Scene scene = bucket_scene(duration);
  const auto add = [&](const char* name, const char* type, auto kind) {
    kind.width = 32;
    kind.height = 24;
    scene::Sensor sensor;
    sensor.name = name;
    sensor.type = type;
    sensor.rate = 10;
    // Behind the bucket, looking down at it.
    sensor.X_LS = make_pose(-3, 0, 2, 0, 0.5, 0);
    sensor.kind = kind;
    scene.machines.front().machine.links.front().sensors.push_back(sensor);
  };
  add("eye", "camera", scene::ColourCamera());
  add("labels", "segmentation", scene::LabelCamera());
  return scene;
}

/// Returns options with a sampler: the array "bucket/height_grid" of 5 x 5 heights at 50 Hz.
inline SimulationOptions with_height_grid(SimulationOptions options = {}) {
  options.set_up = [](session::Session& session) {
    session.add(std::make_unique<sim::testing::HeightGrid>(session.world().machines().at("bucket"),
                                                           5, 0.2, 50));
  };
  return options;
}

}  // namespace navvy::run::test
