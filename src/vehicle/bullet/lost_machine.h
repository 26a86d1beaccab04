// SPDX-License-Identifier: Apache-2.0
// Explains why the Bullet engine lost a machine.
#pragma once

#include <string>

#include "vehicle/bullet/bullet_machine.h"

namespace navvy::vehicle {

/// Returns the likely cause, with its remedy, for which a machine has no finite pose or has fallen
/// through the ground: a link whose inertia does not fit its shape, or a body on it that is too
/// heavy for contacts. `load` is the heaviest body that has pressed on the machine, or null. Empty
/// if none of the two applies.
std::string cause_of_loss(const BulletMachine& machine, const BulletMachine* load);

}  // namespace navvy::vehicle
