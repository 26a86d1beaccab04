// SPDX-License-Identifier: Apache-2.0
// The types of program steps.
#pragma once

#include "scene/step_kind.h"

namespace navvy::control {

/// Returns the table of the program steps that operators can carry out, one row per type of step,
/// to be passed to scene_io::load_scene. A caller with additional types of steps appends their rows
/// to a copy.
const scene::StepKinds& step_kinds();

}  // namespace navvy::control
