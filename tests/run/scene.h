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

/// Returns options with a sampler: the array "bucket/height_grid" of 5 x 5 heights at 50 Hz.
inline SimulationOptions with_height_grid(SimulationOptions options = {}) {
  options.set_up = [](session::Session& session) {
    session.add(std::make_unique<sim::testing::HeightGrid>(session.world().machines().at("bucket"),
                                                           5, 0.2, 50));
  };
  return options;
}

}  // namespace navvy::run::test
