// SPDX-License-Identifier: Apache-2.0
// Shipped scenes without their programs: a world has no operator.
#pragma once

#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "paths.h"
#include "scene_io/loader.h"

namespace navvy::sim::testing {

inline scene::Scene load(const std::string& name, const std::vector<std::string>& settings = {}) {
  scene_io::Overrides overrides;
  overrides.render = false;
  for (const std::string& setting : settings)
    overrides.set.push_back(scene_io::parse_setting(setting));
  return scene_io::load_scene(navvy::source_dir() + "/scenarios/" + name, control::step_kinds(),
                              overrides);
}

}  // namespace navvy::sim::testing
