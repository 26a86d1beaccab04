// SPDX-License-Identifier: Apache-2.0
// Changes of a scene from the command line.
#pragma once

#include "scene/scene.h"
#include "scene_io/loader.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Writes the command-line settings into the document, so that the readers check them like values
/// of the file. The new elements have line 0. Settings for unknown objects are errors; settings
/// without effect are warnings. Single settings (`--set`) are applied last and win over other
/// options.
void apply_overrides(Document& document, const Overrides& overrides, Faults& faults);

/// Adds a warning if the command line gives a seed but nothing in the scene is random.
void warn_of_unused_seed(Document& document, const Overrides& overrides, const scene::Scene& world,
                         Faults& faults);

}  // namespace navvy::scene_io
