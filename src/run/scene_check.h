// SPDX-License-Identifier: Apache-2.0
// What is wrong with a scene, found before it runs.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "scene/scene.h"

namespace navvy::run {

/// Result of a check.
struct SceneCheck {
  std::vector<Fault> faults;       ///< errors and warnings, with file and line; none twice
  std::vector<std::string> notes;  ///< lines for people: the map under the site, how machines stand
};

/// Checks what only a machine on its ground can show: the reach of programs, what the scene
/// records, overlapping machines, and what machines do in their first second. Needs no OpenCL
/// device. Throws only std::bad_alloc.
SceneCheck check_scene(const scene::Scene& scene);

}  // namespace navvy::run
