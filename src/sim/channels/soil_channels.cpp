// SPDX-License-Identifier: Apache-2.0
#include "sim/channels/part_channels.h"
#include "sim/world.h"

namespace navvy::sim {

void add_soil_channels(const ChannelLists& out) {
  out.outputs.add({"soil/particles", "1", "number of active particles"}, [&world = out.world] {
    return static_cast<double>(world.soil().counts().particles);
  });
}

}  // namespace navvy::sim
