// SPDX-License-Identifier: Apache-2.0
// Rigs with tools in the soil; rigs.cpp lists them.
#pragma once

#include "lab/lab.h"
#include "lab/soils.h"

namespace navvy::lab {

Rig blade();
Rig wall();

}  // namespace navvy::lab
