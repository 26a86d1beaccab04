// SPDX-License-Identifier: Apache-2.0
// Reads the couplings between machines.
#pragma once

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads every <navvy:hitch> of a world into `world`, whose machines must have been read. A hitch
/// joins links of two dynamic machines; a machine may be the child in at most one hitch.
void read_hitches(Element& world_element, scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
