// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a <navvy:soil name="..."> with its values, or ref="..." of a shipped soil or of a *.sdf file with one soil,
/// whose values the children then replace.
scene::Soil read_soil(Element& element, Faults& faults);

/// All soils of a soil file (<sdf> with <navvy:soil> children).
std::vector<scene::Soil> read_soil_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
