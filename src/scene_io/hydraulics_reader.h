// SPDX-License-Identifier: Apache-2.0
// Cylinders and the pump that feeds them.
#pragma once

#include "scene/machine.h"
#include "scene_io/machine_names.h"

namespace navvy::scene_io {

/// Reads a <navvy:cylinder>, which acts on its joint directly or through a rocker.
scene::Cylinder read_cylinder(Element& element, const Names& names, Faults& faults);

/// Reads a <navvy:pump>.
void read_pump(Element& element, scene::Pump& pump, Faults& faults);

}  // namespace navvy::scene_io
