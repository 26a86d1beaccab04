// SPDX-License-Identifier: Apache-2.0
// Shells, the surfaces that touch soil.
#pragma once

#include "scene/machine.h"
#include "scene_io/machine_names.h"

namespace navvy::scene_io {

/// Reads a <navvy:shell> with triangles of its own or those of an OBJ file.
scene::Shell read_shell(Element& element, const Names& names, Faults& faults);

}  // namespace navvy::scene_io
