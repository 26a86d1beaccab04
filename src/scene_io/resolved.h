// SPDX-License-Identifier: Apache-2.0
// A scene as one text that stands for itself: what a run's folder keeps.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Of the texts written here; a reader refuses those above it.
inline constexpr int kResolvedFormat = 1;

/// The text of `document` with its overrides, with machines and soils of other files written out in
/// place, and with every mesh and map named so that it is found from anywhere: model://NAME/... for
/// what lies below a vehicles/ directory, else an absolute path. `<navvy:resolved format="1">`
/// lists those files with a hash of each. Reading the text gives `world` again, value by value.
/// `document` must have been read as `world` without a fault; its elements are changed.
std::string resolved_text(Document& document, const scene::Scene& world);

/// What `<navvy:resolved>` of a world promises: an error for a format that is not known here, a
/// warning for each file that has changed since. Nothing for other worlds.
void check_resolved(Document& document, Faults& faults);

}  // namespace navvy::scene_io
