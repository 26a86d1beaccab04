// SPDX-License-Identifier: Apache-2.0
// Machines: a <model> of a scene or of a file of its own.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Reads a <model> with links, joints and all `navvy:` elements of a machine, without its program.
/// The element must have passed `check_sdf`; `sdf_sound` is false if that found a fault.
scene::Machine read_machine(Element& model, bool sdf_sound, Faults& faults);

/// Reads and checks the `navvy:` elements of a <model> alone, with the links and joints that
/// `machine` has already.
void read_extensions(Element& model, const Names& names, scene::Machine& machine, Faults& faults);

/// Reads the <model> of a machine file; returns an empty machine after a fault. Elements that
/// belong to a world, such as a program, are faults.
scene::Machine read_machine_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
