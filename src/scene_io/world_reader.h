// SPDX-License-Identifier: Apache-2.0
// Reads the world of a scene file.
#pragma once

#include "scene/scene.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the <world> of a document to which the overrides have already been applied.
///
/// @param kinds all types of program steps
/// @returns the world. After errors it contains the parts that could be read, and may only be used
/// for further checks.
scene::Scene read_world(Document& document, const scene::StepKinds& kinds, Faults& faults);

}  // namespace navvy::scene_io
