// SPDX-License-Identifier: Apache-2.0
// Reads machines: a <model> in a scene or in a file of its own.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Reads a <model> with links, joints and all `navvy:` elements of a machine, except its program.
/// `check_sdf` must have been called before; `sdf_sound` is false if it found an error.
scene::Machine read_machine(Element& model, bool sdf_sound, Faults& faults);

/// Reads and checks only the `navvy:` elements of a <model>. The links and joints of `machine` must
/// have been read; `names` holds the model's names.
void read_extensions(Element& model, const Names& names, scene::Machine& machine, Faults& faults);

/// Reads the <model> of a machine file; returns a machine without links after an error. Elements
/// that belong to a world, such as a program, are errors.
scene::Machine read_machine_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
