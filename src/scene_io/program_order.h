// SPDX-License-Identifier: Apache-2.0
// Check that programs that wait for each other can all end.
#pragma once

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reports every waiting step that names no other machine with a program, asks for more steps than
/// that has, or is part of a circle of machines waiting for each other, and every step that opens a
/// hitch which its machine does not have. `world` was read from `world_element`.
void check_program_order(Element& world_element, const scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
