// SPDX-License-Identifier: Apache-2.0
// The table of program steps.
#pragma once

#include "scene/step_kind.h"

namespace navvy::control {

/// Returns the program steps that operators can do, for scene_io::load_scene. A caller with steps
/// of its own appends them to a copy.
const scene::StepKinds& step_kinds();

}  // namespace navvy::control
