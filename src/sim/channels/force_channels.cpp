// SPDX-License-Identifier: Apache-2.0
#include "sim/channels/part_channels.h"
#include "sim/world.h"
#include "sim/world_parts.h"

namespace navvy::sim {

// The inputs belong to no machine: wind does not end the program of the machine that it blows on.
void add_force_channels(const MachineChannels& out) {
  constexpr double kMost = 1e9;  // [N] far beyond the weight of any machine
  LinkForces& forces = parts(out.world).forces;
  const scene::Machine& built = out.machine.description();
  for (std::size_t l = 0; l < built.links.size(); ++l) {
    const int force = forces.find(out.machine.index(), static_cast<int>(l));
    if (force < 0) continue;
    const std::string base = out.prefix + built.links[l].name + "/external_force_";
    for (int axis = 0; axis < 3; ++axis)
      out.inputs.add(
          {base + kAxisNames[axis], "N",
           "force from outside on the link's point, world axes; acts until it is set again", -1,
           -kMost, kMost},
          [&forces, force, axis](double value) {
            Vec3 f_W = forces.get(force);
            f_W[axis] = value;
            forces.set(force, f_W);
          });
  }
}

}  // namespace navvy::sim
