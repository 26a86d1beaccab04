// SPDX-License-Identifier: Apache-2.0
// Finds errors in a scene before it runs.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "scene/scene.h"

namespace navvy::run {

/// Result of checking a scene.
struct SceneCheck {
  /// Errors and warnings, with file and line where known. Each is listed only once.
  std::vector<Fault> faults;
  /// Information for the user, one line per entry: the terrain file, the design surface, and how
  /// stable the machines stand.
  std::vector<std::string> notes;
};

/// Checks what the scene file alone does not show: whether machines can reach the targets of their
/// programs, whether records can be written, whether sensors have a free view and a rate that the
/// steps allow, whether machines overlap, and how machines behave during the first second on the
/// ground. Needs no OpenCL device. Errors are returned; the only exception thrown is
/// std::bad_alloc.
SceneCheck check_scene(const scene::Scene& scene);

}  // namespace navvy::run
