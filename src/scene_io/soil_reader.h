// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a <navvy:soil name="..."> with its values, or ref="..." of a shipped soil or of a *.sdf
/// file with one soil, whose values the children then replace. The soil that is answered after a
/// fault is good for reading on, not for a run.
scene::Soil read_soil(Element& element, Faults& faults);

/// The file that `ref` of a <navvy:soil> means: *.sdf counts from the element's file, a plain name
/// is a shipped soil's. Empty when a plain name is none.
std::string soil_file(const Element& element, const std::string& ref);

/// All soils of a soil file (<sdf> with <navvy:soil> children).
std::vector<scene::Soil> read_soil_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
