// SPDX-License-Identifier: Apache-2.0
// Applies changes to a scene from the command line.
#pragma once

#include "scene/scene.h"
#include "scene_io/loader.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Writes the overrides into the document, so that they are checked like values of the file.
/// Elements added here have line 0. Unknown objects are errors, settings without effect are
/// warnings. `overrides.set` is applied last, so that it takes precedence over the other overrides.
void apply_overrides(Document& document, const Overrides& overrides, Faults& faults);

/// Reports a warning if a seed is given on the command line but nothing in the scene is random.
void warn_of_unused_seed(Document& document, const Overrides& overrides, const scene::Scene& world,
                         Faults& faults);

}  // namespace navvy::scene_io
