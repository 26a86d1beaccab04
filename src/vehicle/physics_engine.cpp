// SPDX-License-Identifier: Apache-2.0
#include "vehicle/physics_engine.h"

#include <string>

#include "core/error.h"

namespace navvy::vehicle {

void PhysicsEngine::set_base(int machine, const BaseInput& input) {
  (void)input;
  throw InputError(
      Fault{Fault::Severity::kError, "", 0, "machine", std::to_string(machine),
            "forces move this machine: it cannot be put anywhere",
            "set <navvy:engine>kinematic</navvy:engine>, or command its joints and drive"});
}

int PhysicsEngine::add_mover(const scene::Machine& machine) {
  (void)machine;
  return -1;
}

void PhysicsEngine::move(int mover, const std::vector<LinkState>& links) {
  (void)mover, (void)links;
}

namespace {

[[noreturn]] void refuse_hitch() {
  throw InputError(Fault{Fault::Severity::kError, "", 0, "hitch", "",
                         "a hitch joins machines that forces move",
                         "set <navvy:engine>dynamic</navvy:engine>, or move it by its pose"});
}

}  // namespace

int PhysicsEngine::add_hitch(const scene::Hitch& hitch, int parent, int child) {
  (void)hitch, (void)parent, (void)child;
  refuse_hitch();
}

void PhysicsEngine::set_hitch(int hitch, bool closed) {
  (void)hitch, (void)closed;
  refuse_hitch();
}

HitchState PhysicsEngine::hitch(int hitch) const {
  (void)hitch;
  refuse_hitch();
}

BaseInput PhysicsEngine::base(int machine) const {
  const Pose X = link(machine, 0).X_WL;
  BaseInput out;
  out.p_W = X.translation();
  out.angles = fixed_angles(X.linear());
  return out;
}

}  // namespace navvy::vehicle
