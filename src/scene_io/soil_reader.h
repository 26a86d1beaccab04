// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a <navvy:soil> with its values. With the attribute `ref`, which names a shipped soil or a
/// *.sdf file with one soil, the values are taken from there, and the children replace single
/// values.
scene::Soil read_soil(Element& element, Faults& faults);

/// Returns the path of the file that `ref` names: a name that ends in .sdf is relative to the file
/// of `element`; any other name is a shipped soil. Returns an empty text for an unknown soil.
std::string soil_file(const Element& element, const std::string& ref);

/// Reads all soils of a soil file, which has <navvy:soil> children below <sdf>.
std::vector<scene::Soil> read_soil_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
