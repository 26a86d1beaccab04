// SPDX-License-Identifier: Apache-2.0
#include "sim/link_forces.h"

#include "coupling/coupling.h"
#include "vehicle/physics_engine.h"

namespace navvy::sim {

LinkForces::LinkForces(const scene::Scene& scene) {
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    const std::vector<scene::Link>& links = scene.machines[m].machine.links;
    for (std::size_t l = 0; l < links.size(); ++l)
      if (const auto& input = links[l].force_input)
        forces_.push_back({static_cast<int>(m), static_cast<int>(l),
                           input->has_point ? input->p_L : links[l].p_LCom, Vec3::Zero()});
  }
}

int LinkForces::find(int machine, int link) const {
  for (std::size_t i = 0; i < forces_.size(); ++i)
    if (forces_[i].machine == machine && forces_[i].link == link) return static_cast<int>(i);
  return -1;
}

// A force of zero must not activate a body at rest.
void LinkForces::push(coupling::Coupling& coupling) const {
  for (const Force& force : forces_) {
    if (force.f_W.isZero(0)) continue;
    vehicle::PhysicsEngine& engine = coupling.engine(force.machine);
    const int index = coupling.index(force.machine);
    engine.add_force(index, force.link, force.f_W, engine.link(index, force.link).X_WL * force.p_L);
  }
}

void LinkForces::Force::visit(Archive& a) {
  a("f_W", f_W);
  a.require(f_W.allFinite(), "f_W", "a force must be finite");
}

void LinkForces::visit(Archive& a) { a.fixed("forces", forces_); }

}  // namespace navvy::sim
