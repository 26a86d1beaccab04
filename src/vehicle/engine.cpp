// SPDX-License-Identifier: Apache-2.0
#include "vehicle/engine.h"

#include <string>

#include "core/error.h"

namespace navvy::vehicle {

void Engine::set_base(int machine, const BaseInput& input) {
  (void)input;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "machine", std::to_string(machine),
                         "forces move this machine: it cannot be put anywhere",
                         "set <navvy:engine>kinematic</navvy:engine>, or command its joints and drive"});
}

int Engine::add_mover(const scene::Machine& machine) {
  (void)machine;
  return -1;
}

void Engine::move(int mover, const std::vector<LinkState>& links) { (void)mover, (void)links; }

BaseInput Engine::base(int machine) const {
  const Pose X = link(machine, 0).X_WL;
  BaseInput out;
  out.p_W = X.translation();
  out.angles = fixed_angles(X.linear());
  return out;
}

}  // namespace navvy::vehicle
