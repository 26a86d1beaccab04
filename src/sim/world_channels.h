// SPDX-License-Identifier: Apache-2.0
// Fills the channel lists of a world, and prints them.
#pragma once

#include <string>

#include "sim/channels.h"
#include "sim/handles.h"

namespace navvy::sim {

class World;

/// Declares the channels of every part (sim/channels/part_channels.h). The world calls it once,
/// before any sampler declares its own. The world must outlive the lists.
void add_channels(World& world, Inputs& inputs, Outputs& outputs);

/// Declares pose, velocity and angular velocity of a link of `machine`, unless they exist.
void add_link(const LinkHandle& link, const std::string& machine, Outputs& outputs);

/// Returns what `navvy channels` prints: inputs, outputs and arrays with unit and meaning, one per
/// line; arrays also with element type, shape, frame and rate.
std::string channel_list(const World& world);

}  // namespace navvy::sim
