// SPDX-License-Identifier: Apache-2.0
// <navvy:hitch>: what couples two machines of a world.
#pragma once

#include "scene/scene.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads every hitch of a world, after its machines. Each joins `machine::link` with another
/// machine's, both moved by forces; a machine hangs on one hook at most.
void read_hitches(Element& world_element, scene::Scene& world, Faults& faults);

}  // namespace navvy::scene_io
