// SPDX-License-Identifier: Apache-2.0
// Reads the triangles of shells, the surfaces that touch soil.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Sets the triangles of a shell after its <navvy:shell> has been read: those listed in the
/// element, or those of the OBJ file that it names. Checks that every triangle has an area and that
/// all triangles are wound consistently.
void finish_shell(Element& element, scene::Shell& shell, Faults& faults);

}  // namespace navvy::scene_io
