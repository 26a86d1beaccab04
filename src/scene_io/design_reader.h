// SPDX-License-Identifier: Apache-2.0
// <navvy:design>: what the site shall become.
#pragma once

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the design, a LandXML file it names at once; rasters are read when the ground is known.
scene::Design read_design(Element& element, Faults& faults);

}  // namespace navvy::scene_io
