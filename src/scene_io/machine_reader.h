// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/machine_names.h"

namespace navvy::scene_io {

/// Reads a <model> with links, joints and all `navvy:` elements of a machine (not its program).
/// `static_base` is set by an including world. The element must have passed `check_sdf`;
/// `sdf_sound` says that it passed without a fault.
scene::Machine read_machine(Element& model, bool sdf_sound, Faults& faults);

/// The `navvy:` elements of a <model> alone, beside the links and joints that `machine` has
/// already; without links only what can be said without them.
void read_extensions(Element& model, const Names& names, scene::Machine& machine, Faults& faults);

/// Sets the initial position of the joint named by a <navvy:joint name="...">.
void read_initial_position(Element& element, scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
