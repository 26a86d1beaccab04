// SPDX-License-Identifier: Apache-2.0
// Couplings of machines.
#pragma once

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads every <navvy:hitch> of a world, after its machines. Each joins links of two dynamic
/// machines; a machine is the child of one hitch at most.
void read_hitches(Element& world_element, scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
