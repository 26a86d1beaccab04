// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/soil.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a <navvy:soil>. If it has an attribute `ref`, the shipped soil or *.sdf file of that name
/// gives the initial values, which the child elements replace. After an error the result may be
/// used for further checks but not for a run.
scene::Soil read_soil(Element& element, Faults& faults);

/// Returns the path of the soil file that the attribute `ref` means: a name ending in .sdf is
/// relative to the element's file, any other name is that of a shipped soil. Returns an empty text
/// for an unknown shipped soil.
std::string soil_file(const Element& element, const std::string& ref);

/// Reads all soils of a soil file (<sdf> with <navvy:soil> elements).
std::vector<scene::Soil> read_soil_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
