// SPDX-License-Identifier: Apache-2.0
// Soil law and particle arithmetic of kernels/soil/law.h and point.h, compiled in double precision
// for the host.
#pragma once

#include "soil/host_law/double_real.h"

namespace navvy::soil::reference {

// The law is compiled with all of its extensions: those that a soil does not use have no effect.
#define LAW_EXTENDED
#include "soil/point.h"  // NOLINT: on purpose inside the namespace
#undef LAW_EXTENDED

}  // namespace navvy::soil::reference
