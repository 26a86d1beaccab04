// SPDX-License-Identifier: Apache-2.0
// The design surface of a site.
#pragma once

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:design> and, if it names a LandXML file, the surface in that file. A raster file is
/// read later, together with the ground.
scene::Design read_design(Element& element, Faults& faults);

}  // namespace navvy::scene_io
