// SPDX-License-Identifier: Apache-2.0
// Checks that programs which wait for each other can all finish.
#pragma once

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reports an error for every waiting step that names no other machine with a program, waits for
/// more steps than that program has, or is part of a circle of machines that wait for each other;
/// and for every step that opens a hitch which its machine does not have. `world` must have been
/// read from `world_element`.
void check_program_order(Element& world_element, const scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
