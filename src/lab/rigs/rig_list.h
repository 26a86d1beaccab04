// SPDX-License-Identifier: Apache-2.0
// One function per rig; each returns the description of its rig. To add a rig, put a file into this
// folder, a line into this header and a line into rigs.cpp. The command line, its help and the
// parameter checks follow from the description.
#pragma once

#include "lab/rig.h"

namespace navvy::lab {

// `navvy lab RIG --help` prints what each rig does, its parameters and examples.

// Soil by itself.
Rig rest_rig();
Rig column_rig();
Rig pour_rig();
Rig cone_rig();
Rig slope_rig();
Rig slide_rig();
Rig throw_rig();
Rig swell_rig();
Rig shear_rig();
Rig triaxial_rig();

// Soil and tools.
Rig blade_rig();
Rig wall_rig();
Rig footing_rig();
Rig plate_rig();
Rig wheel_rig();
Rig cut_rig();
Rig shear_box_rig();
Rig hold_rig();
Rig light_tool_rig();
Rig stand_rig();
Rig bucket_rig();
Rig scrape_rig();
Rig cycle_rig();

}  // namespace navvy::lab
