// SPDX-License-Identifier: Apache-2.0
// Fills the channel lists (named inputs and outputs) of a world, and lists them as text.
#pragma once

#include <string>

#include "sim/channels.h"
#include "sim/handles.h"

namespace navvy::sim {

class World;

/// Declares the inputs and outputs of all parts of `world` (sim/channels/part_channels.h). The
/// world calls it once, before samplers add their outputs. The world must outlive both lists.
void add_channels(World& world, Inputs& inputs, Outputs& outputs);

/// Declares outputs for pose, velocity and angular velocity of a link, unless they exist already.
/// `machine` is the name of the link's machine.
void add_link(const LinkHandle& link, const std::string& machine, Outputs& outputs);

/// Returns the list that `navvy channels` prints: one line per input, output and array, with name,
/// unit and meaning. Lines of arrays also give element type, shape, frame and rate.
std::string channel_list(const World& world);

}  // namespace navvy::sim
