// SPDX-License-Identifier: Apache-2.0
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

// Commands are held until replaced, so they are part of the state of whoever holds them.
void JointInput::visit(Archive& a) {
  a.ranged("mode", mode, JointMode::kFree, JointMode::kEffort);
  a("target", target);
}

void DriveInput::visit(Archive& a) {
  a("speed", speed);
  a("steer", steer);
  a("brake", brake);
}

}  // namespace navvy::vehicle
