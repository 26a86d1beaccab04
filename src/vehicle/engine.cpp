// SPDX-License-Identifier: Apache-2.0
#include "vehicle/engine.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace navvy::vehicle {

void Engine::set_base(int machine, const BaseInput& input) {
  (void)input;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "machine", std::to_string(machine),
                         "forces move this machine: it cannot be put anywhere",
                         "set <navvy:engine>kinematic</navvy:engine>, or command its joints and drive"});
}

BaseInput Engine::base(int machine) const {
  const Pose X = link(machine, 0).X_WL;
  const Mat3 R = X.linear();
  BaseInput out;
  out.p_W = X.translation();
  // Rounding may take the sine a hair past one.
  out.angles = {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)), std::atan2(R(1, 0), R(0, 0))};
  return out;
}

}  // namespace navvy::vehicle
