// SPDX-License-Identifier: Apache-2.0
// The design surface of a site.
#pragma once

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a <navvy:design> and the LandXML file it may name. (A raster file is read later, when the
/// ground is built.)
scene::Design read_design(Element& element, Faults& faults);

}  // namespace navvy::scene_io
