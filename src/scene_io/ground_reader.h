// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/ground.h"
#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:ground>; layers may only name `soils`. Without a layer and with one soil, that soil fills the ground.
scene::Ground read_ground(Element& element, const std::vector<scene::Soil>& soils, Faults& faults);

}  // namespace navvy::scene_io
