// SPDX-License-Identifier: Apache-2.0
// Worlds: a whole scene.
#pragma once

#include "scene/scene.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the <world> of a document, after the overrides were applied to it.
///
/// @param kinds the known program steps
/// @returns the world; after a fault the parts that could be read, for further checks alone.
scene::Scene read_world(Document& document, const scene::StepKinds& kinds, Faults& faults);

}  // namespace navvy::scene_io
