// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "sim/channels/part_channels.h"
#include "sim/world.h"

namespace navvy::sim {

// The inputs belong to no machine: opening a hitch does not end the program of the towed machine.
void add_hitch_channels(const ChannelLists& out) {
  World& world = out.world;
  const std::vector<scene::Hitch>& hitches = world.description().hitches;
  for (std::size_t i = 0; i < hitches.size(); ++i) {
    const int hitch = static_cast<int>(i);
    // A hitch is named after the machine that is towed: it has one, its tractor may have several.
    const std::string base =
        world.machines().at(hitches[i].child).name() + "/" + hitches[i].name + "/";
    out.inputs.add(
        {base + "closed", "1", "0 opens, 1 closes if the eye is within 0.1 m of the hook", -1, 0, 1,
         true},
        [&world, hitch](double closed) { world.commands().set_hitch(hitch, closed != 0); });
    out.outputs.add({base + "closed", "1", "1 while it is closed"},
                    [&world, hitch] { return world.machines().hitch(hitch).closed ? 1.0 : 0.0; });
    out.outputs.add({base + "apart", "m", "distance of the eye from the hook"},
                    [&world, hitch] { return world.machines().hitch(hitch).apart; });
    for (int a = 0; a < 3; ++a)
      out.outputs.add({base + "force_" + kAxisNames[a], "N",
                       "force of the towed machine on the towing one, world axes"},
                      [&world, hitch, a] { return world.machines().hitch(hitch).force[a]; });
  }
}

}  // namespace navvy::sim
