// SPDX-License-Identifier: Apache-2.0
// Reads the ground of a world, and finds the maps that ground and design name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/ground.h"
#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:ground>. Layers may only name the soils in `soils`; if no layer is given and there
/// is one soil, that soil fills the ground. Hills without a seed of their own use `seed`.
/// Contradictory elements, such as shapes together with a map, are errors.
scene::StartGround read_ground(Element& element, const std::vector<scene::Soil>& soils,
                               std::uint64_t seed, Faults& faults);

/// Replaces the file name of a map in `path` by a full path. A name in a scene file is relative to
/// the directory of that file, a name on the command line to the working directory. Reports an
/// error at `element` if the file is missing.
void resolve_raster(const Element& element, std::string& path, Faults& faults);

}  // namespace navvy::scene_io
