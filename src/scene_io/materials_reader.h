// SPDX-License-Identifier: Apache-2.0
// Tables of pairs of materials, in a scene or in a file of their own.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a scene's <navvy:materials>: first the pairs of the file that it may name, then its own
/// pairs. A pair that occurs twice is an error.
scene::Materials read_materials(Element& element, Faults& faults);

/// Adds the pairs of a materials file (<sdf> with <navvy:materials>) to `into`.
void read_materials_file(const std::string& file, scene::Materials& into, Faults& faults);

/// Returns the path of the materials file named in the element `file`: relative to the scene file,
/// else a shipped file in terrain/. Returns an empty text if there is no such file.
std::string materials_file(const Element& file);

/// Reports an error for each pair of materials that can touch in the scene but is missing in its
/// table: materials of different machines, and each material with the ground's. Messages name the
/// link that has the material.
void check_materials(const scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
