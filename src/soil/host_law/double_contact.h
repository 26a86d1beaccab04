// SPDX-License-Identifier: Apache-2.0
// Contact and node arithmetic of kernels/soil/contact_law.h and node.h, compiled in double
// precision for the host.
#pragma once

#include "soil/host_law/double_real.h"

namespace navvy::soil::reference {

#include "soil/contact_law.h"  // NOLINT: on purpose inside the namespace
#include "soil/node.h"         // NOLINT: the same

}  // namespace navvy::soil::reference
