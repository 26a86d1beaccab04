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

/// Reads a <navvy:ground>. `soils` are the world's soils; without layers, a single soil fills the
/// ground. `seed` is used for hills without a seed of their own. Contradictory elements, such as
/// shapes on a map, are errors.
scene::StartGround read_ground(Element& element, const std::vector<scene::Soil>& soils,
                               std::uint64_t seed, Faults& faults);

/// Converts the name of a map file to a path. A relative name in a scene file is relative to that
/// file; one from the command line is relative to the working directory. Reports an error at
/// `element` if the file does not exist.
void resolve_raster(const Element& element, std::string& path, Faults& faults);

}  // namespace navvy::scene_io
