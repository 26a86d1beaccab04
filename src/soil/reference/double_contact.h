// SPDX-License-Identifier: Apache-2.0
// Contact and node arithmetic of kernels/soil/contact_law.h and node.h, compiled in double
// precision for the host.
#pragma once

#include "soil/reference/double_real.h"

namespace navvy::soil::reference {

#include "soil/contact_law.h"  // NOLINT: on purpose inside the namespace
#include "soil/node.h"         // NOLINT: the same

/// Returns the impulse [N s] on a node from a plate that moves with `speed` [m/s] relative to the
/// resting ground and does not rotate. `opening`: separation speed above which adhesion has ended
/// [m/s].
inline Vec3 impulse_on(const ContactNode& node, double opening, const Vec3& speed = Vec3::Zero()) {
  ContactBranch branch;
  return contact_impulse(&node, Vec3::Zero(), speed, opening, &branch);
}

}  // namespace navvy::soil::reference
