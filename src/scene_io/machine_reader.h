// SPDX-License-Identifier: Apache-2.0
// Machines: a <model> of a scene or of a file of its own.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Reads a machine from a <model>: links, joints and all navvy: elements except those that belong
/// to a world, such as the program. `check_sdf` must have checked the element; `sdf_sound` is false
/// if it found an error.
scene::Machine read_machine(Element& model, bool sdf_sound, Faults& faults);

/// Reads and checks only the navvy: elements of a <model>. `machine` contains the links and joints
/// already.
void read_extensions(Element& model, const Names& names, scene::Machine& machine, Faults& faults);

/// Reads the machine of a machine file. Returns an empty machine after an error. Elements that
/// belong to a world, such as a program, are errors.
scene::Machine read_machine_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
