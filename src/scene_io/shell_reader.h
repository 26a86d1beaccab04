// SPDX-License-Identifier: Apache-2.0
// Triangles of shells, the surfaces that touch soil.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Builds the triangles of a shell from the lists in its <navvy:shell> or from the OBJ file that
/// the element names. Reports triangles without area and inconsistent winding. The shell's other
/// fields must have been read.
void finish_shell(Element& element, scene::Shell& shell, Faults& faults);

}  // namespace navvy::scene_io
