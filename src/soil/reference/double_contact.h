// SPDX-License-Identifier: Apache-2.0
// Contact and node arithmetic of kernels/soil/contact_law.h and node.h compiled for doubles.
#pragma once

#include "soil/reference/double_real.h"

namespace navvy::soil::reference {

#include "soil/contact_law.h"  // NOLINT: on purpose inside the namespace
#include "soil/node.h"         // NOLINT: the same

/// Impulse on a node whose velocity is relative to the plate [N s].
inline Vec3 impulse_on(const ContactNode& node, double opening) {
  ContactBranch branch;
  return contact_impulse(&node, Vec3::Zero(), Vec3::Zero(), opening, &branch);
}

}  // namespace navvy::soil::reference
