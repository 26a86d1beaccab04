// SPDX-License-Identifier: Apache-2.0
// Worlds: a whole scene.
#pragma once

#include "scene/scene.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the <world> of a document. Command-line settings must have been applied to the document.
///
/// @param kinds known types of program steps
/// @returns the scene; after an error only the parts that could be read, which may be used for
/// further checks but not for a run
scene::Scene read_world(Document& document, const scene::StepKinds& kinds, Faults& faults);

}  // namespace navvy::scene_io
