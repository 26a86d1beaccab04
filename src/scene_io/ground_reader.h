// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scene/ground.h"
#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:ground>; layers may only name `soils`. Without a layer and with one soil, that soil
/// fills the ground. Hills without a seed take `seed`. What contradicts itself, such as shapes on a
/// map, is a fault; whether the site has a sensible number of cells is checked with the whole
/// world.
scene::StartGround read_ground(Element& element, const std::vector<scene::Soil>& soils,
                               std::uint64_t seed, Faults& faults);

}  // namespace navvy::scene_io
