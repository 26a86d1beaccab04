// SPDX-License-Identifier: Apache-2.0
// The ground of a world, and maps that ground and design are read from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/ground.h"
#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:ground>. Layers may name `soils` only; without a layer, a single soil fills the
/// ground. Hills without a seed use `seed`. Contradictions, such as shapes on a map, are faults.
scene::StartGround read_ground(Element& element, const std::vector<scene::Soil>& soils,
                               std::uint64_t seed, Faults& faults);

/// Turns the name of a map into a path: in a scene it counts from the scene's file, on the command
/// line from the working directory. A missing file is a fault.
void resolve_raster(const Element& element, std::string& path, Faults& faults);

}  // namespace navvy::scene_io
