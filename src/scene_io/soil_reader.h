// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a <navvy:soil name="..."> with its values, or ref="..." of a shipped soil or of a *.sdf
/// file with one soil, whose values the children replace.
scene::Soil read_soil(Element& element, Faults& faults);

/// Returns the file that `ref` names: *.sdf counts from the element's file, others are names of
/// shipped soils. Returns an empty text for an unknown soil.
std::string soil_file(const Element& element, const std::string& ref);

/// Reads all soils of a soil file (<sdf> with <navvy:soil> children).
std::vector<scene::Soil> read_soil_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
