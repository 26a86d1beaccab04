// SPDX-License-Identifier: Apache-2.0
// A scene as one text without references to other scene files, for the folder of a run.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Format of the texts written here; readers refuse later ones.
inline constexpr int kResolvedFormat = 1;

/// Returns the text of `document` with its overrides, with machines and soils of other files
/// written out in place, and with portable names of meshes and maps: model://NAME/... below a
/// vehicles/ directory, else an absolute path. `<navvy:resolved format="1">` lists those files with
/// a hash of each. Reading the text gives `world` again, value by value. `document` must have been
/// read as `world` without a fault; its elements are changed.
std::string resolved_text(Document& document, const scene::Scene& world);

/// Checks the <navvy:resolved> of a world, if it has one: an unknown format is an error, a file
/// that has changed since a warning.
void check_resolved(Document& document, Faults& faults);

}  // namespace navvy::scene_io
