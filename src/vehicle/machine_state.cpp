// SPDX-License-Identifier: Apache-2.0
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

// Commands hold until they are replaced, so they are part of their owner's state.
void JointInput::visit(Archive& a) {
  a.ranged("mode", mode, JointMode::kFree, JointMode::kOpening);
  a("target", target);
}

void BaseInput::visit(Archive& a) {
  a("p_W", p_W);
  a("angles", angles);
  a("duration", duration);
}

void CombustionEngineState::visit(Archive& a) {
  a("speed", speed);
  a("torque", torque);
  a("power", power);
  a("gear", gear);
}

void DriveInput::visit(Archive& a) {
  a("speed", speed);
  a("steer", steer);
  a("brake", brake);
}

}  // namespace navvy::vehicle
