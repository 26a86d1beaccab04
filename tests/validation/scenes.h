// SPDX-License-Identifier: Apache-2.0
// Shipped scenes with changed values, and one device for all cases of the program.
#pragma once

#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::validation {

/// Returns a shipped scene without pictures, or one of another folder of the tree; `settings` as
/// with `navvy run --set`.
inline scene::Scene load_scene(const std::string& name,
                               const std::vector<std::string>& settings = {},
                               const std::string& folder = "scenarios") {
  scene_io::Overrides overrides;
  overrides.render = false;
  for (const std::string& setting : settings)
    overrides.set.push_back(scene_io::parse_setting(setting));
  return scene_io::load_scene(navvy::source_dir() + "/" + folder + "/" + name,
                              control::step_kinds(), overrides);
}

/// Returns a shared device, so that kernels are built once.
inline device::Device& shared_device() {
  static device::Device device;
  return device;
}

inline void run_to(session::Session& session, double time) {
  while (session.world().time() < time) session.step();
}

}  // namespace navvy::validation
