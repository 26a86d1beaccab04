// SPDX-License-Identifier: Apache-2.0
// Fills the channel lists of a world.
#pragma once

#include <string>
#include <vector>

#include "sim/channels.h"

namespace navvy::sim {

class World;

/// Joints, drive, pose, wheels and tools of every machine, and a few sums of the soil. The world must outlive the
/// lists.
void add_channels(World& world, Inputs& inputs, Outputs& outputs);

/// Most similar channel name by edit distance; empty when there are none.
std::string nearest_name(const std::vector<Channel>& channels, const std::string& name);

/// `found` when it is >= 0. @throws InputError that names the nearest channel otherwise.
int require_channel(int found, const std::vector<Channel>& channels, const std::string& name, const std::string& kind);

}  // namespace navvy::sim
