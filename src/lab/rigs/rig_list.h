// SPDX-License-Identifier: Apache-2.0
// One function per rig, each in a file of the rig's name; rigs.cpp lists them.
#pragma once

#include "lab/lab.h"

namespace navvy::lab {

Rig rest();
Rig column();
Rig pour();
Rig cone();
Rig slope();
Rig slide();
Rig throw_apart();
Rig swell();

}  // namespace navvy::lab
