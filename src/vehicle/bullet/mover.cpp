// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/mover.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace navvy::vehicle {

// Builds a machine of one fixed link for each link with shapes.
Mover::Mover(const scene::Machine& machine) {
  for (std::size_t l = 0; l < machine.links.size(); ++l) {
    scene::Machine body;
    body.name = machine.name;
    body.fixed_base = true;
    body.links = {machine.links[l]};
    // A fixed body needs neither, but its tree requires both.
    body.links[0].mass = 1;
    body.links[0].p_LCom = Vec3::Zero();
    body.links[0].inertia = Mat3::Identity();
    body.links[0].X_ML = Pose::Identity();
    std::copy_if(machine.shells.begin(), machine.shells.end(), std::back_inserter(body.shells),
                 [&](const scene::Shell& shell) { return shell.link == body.links[0].name; });
    if (body.links[0].collisions.empty() && body.shells.empty()) continue;
    link_.push_back(l);
    bodies_.push_back(std::make_unique<BulletMachine>(body, Pose::Identity()));
  }
}

void Mover::move(const std::vector<LinkState>& links) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b]->move_base(links.at(link_[b]));
}

}  // namespace navvy::vehicle
