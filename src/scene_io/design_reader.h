// SPDX-License-Identifier: Apache-2.0
// The design surface of a site.
#pragma once

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:design> and the LandXML file it names. A raster is read later, with the ground.
scene::Design read_design(Element& element, Faults& faults);

}  // namespace navvy::scene_io
