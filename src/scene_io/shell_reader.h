// SPDX-License-Identifier: Apache-2.0
// Triangles of shells, the surfaces that touch soil.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Gives a shell, whose <navvy:shell> was read, its triangles: those in the element or those of an
/// OBJ file. Checks that every triangle has an area and that all are wound alike.
void finish_shell(Element& element, scene::Shell& shell, Faults& faults);

}  // namespace navvy::scene_io
