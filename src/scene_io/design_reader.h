// SPDX-License-Identifier: Apache-2.0
// The design surface of a site, and areas of it.
#pragma once

#include <vector>

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Returns the corners of the polygon whose coordinates x y x y ... the element `at` lists, as
/// `numbers` [m]. Reports an error and returns no corner unless they make a simple polygon.
std::vector<Vec2> polygon_of(const Element& at, const std::vector<double>& numbers, Faults& faults);

/// Reads <navvy:design> and, if it names a LandXML file, the surface in that file. A raster file is
/// read later, together with the ground.
scene::Design read_design(Element& element, Faults& faults);

}  // namespace navvy::scene_io
