// SPDX-License-Identifier: Apache-2.0
// Reads tables of material pairs from a scene or from files of their own.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:materials> of a scene: first the table in its <file>, then the pairs in the scene.
scene::Materials read_materials(Element& element, Faults& faults);

/// Adds the pairs of a materials file, whose root contains <navvy:materials>, to `into`.
void read_materials_file(const std::string& file, scene::Materials& into, Faults& faults);

/// Returns the path of the materials file that the element `file` names: relative to the scene
/// file, otherwise among the shipped tables in terrain/; an empty text if there is none.
std::string materials_file(const Element& file);

/// Checks that the table has a pair for any two materials that may touch: materials of different
/// machines, and each material with that of the ground. Errors are reported at the link with the
/// material.
void check_materials(const scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
