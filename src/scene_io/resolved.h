// SPDX-License-Identifier: Apache-2.0
// Writes a scene as one text without references to other scene files, for the folder of a run.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Version of the format in which scenes are written as one text. Reading a text with a later
/// version is an error.
inline constexpr int kResolvedFormat = 1;

/// Returns the document as one text that includes the overrides and, in place of references, the
/// machines and soils of other files. Names of files that remain, such as meshes and maps, are made
/// portable: model://NAME/... in a vehicles/ directory, otherwise absolute paths. The element
/// `<navvy:resolved format="1">` lists these files with a hash of each. Reading the text gives a
/// scene that equals `world` in every value. `world` must have been read from `document` without
/// errors; the elements of `document` are changed.
std::string resolved_text(Document& document, const scene::Scene& world);

/// Checks the element <navvy:resolved> of a world, if there is one. An unknown format is an error;
/// a listed file that has changed since is a warning.
void check_resolved(Document& document, Faults& faults);

}  // namespace navvy::scene_io
