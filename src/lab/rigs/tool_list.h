// SPDX-License-Identifier: Apache-2.0
// Rigs with tools in the soil; rigs.cpp lists them.
#pragma once

#include "lab/lab.h"
#include "lab/soils.h"

namespace navvy::lab {

Rig blade();
Rig wall();
Rig footing();
Rig plate_sinkage();
Rig wheel();
Rig cut();
Rig shear_box();
Rig hold();
Rig light_tool();
Rig bucket();
Rig scrape();
Rig cycle();

}  // namespace navvy::lab
