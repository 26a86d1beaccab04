// SPDX-License-Identifier: Apache-2.0
// Couplings of machines.
#pragma once

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads all <navvy:hitch> elements of a world into `world.hitches`. The machines must have been
/// read. Each hitch joins links of two different dynamic machines, and a machine can be the child
/// of one hitch only.
void read_hitches(Element& world_element, scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
