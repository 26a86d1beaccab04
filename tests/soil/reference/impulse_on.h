// SPDX-License-Identifier: Apache-2.0
// Impulse of a plate on a node, computed by the double-precision twin.
#pragma once

#include "core/math.h"
#include "soil/host_law/double_contact.h"

namespace navvy::soil::reference {

/// Returns the impulse [N s] on a node from a plate that moves with `speed` [m/s] relative to the
/// resting ground and does not rotate. `opening`: separation speed above which adhesion has ended
/// [m/s].
inline Vec3 impulse_on(const ContactNode& node, double opening, const Vec3& speed = Vec3::Zero()) {
  ContactBranch branch;
  return contact_impulse(&node, Vec3::Zero(), speed, opening, &branch);
}

}  // namespace navvy::soil::reference
