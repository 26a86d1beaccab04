// SPDX-License-Identifier: Apache-2.0
// Changes of a scene from the command line.
#pragma once

#include "scene/scene.h"
#include "scene_io/loader.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Writes the overrides into the document, so that reading checks them like the file's own values.
/// Elements written here have line 0. Reports unknown objects, and settings without effect as
/// warnings. Settings come last, so they win over an option for the same value.
void apply_overrides(Document& document, const Overrides& overrides, Faults& faults);

/// Warns of a seed given on the command line if nothing in the scene is random.
void warn_of_unused_seed(Document& document, const Overrides& overrides, const scene::Scene& world,
                         Faults& faults);

}  // namespace navvy::scene_io
