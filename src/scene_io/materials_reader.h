// SPDX-License-Identifier: Apache-2.0
// <navvy:materials>: how materials touch, by pairs, in the scene or in a file of their own.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the table of a scene: its <file>, then the pairs that stand beside it. A pair is told
/// once.
scene::Materials read_materials(Element& element, Faults& faults);

/// A file whose root holds <navvy:materials>.
void read_materials_file(const std::string& file, scene::Materials& into, Faults& faults);

/// Path of the table that `file` names: beside the scene, else among the shipped ones (terrain/);
/// empty when there is none.
std::string materials_file(const Element& file);

/// What may touch in the scene must be a pair of its table: materials of different machines, and
/// each with the ground's. Told at the link that names the material.
void check_materials(const scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
