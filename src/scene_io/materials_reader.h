// SPDX-License-Identifier: Apache-2.0
// Tables of pairs of materials, in a scene or in a file of their own.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the table of a scene: that of its <file>, then its own pairs.
scene::Materials read_materials(Element& element, Faults& faults);

/// Adds the pairs of a file with <navvy:materials> below its root.
void read_materials_file(const std::string& file, scene::Materials& into, Faults& faults);

/// Returns the path of the table that `file` names: beside the scene, else among the shipped ones
/// (terrain/); empty if there is none.
std::string materials_file(const Element& file);

/// Checks that the table has a pair for all that may touch: materials of different machines, and
/// each with the ground's. Faults are reported at the link with the material.
void check_materials(const scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
