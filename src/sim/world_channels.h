// SPDX-License-Identifier: Apache-2.0
// Fills the channel lists of a world, and lists them for people.
#pragma once

#include <string>

#include "sim/channels.h"
#include "sim/handles.h"

namespace navvy::sim {

class World;

/// Joints, drive, pose, wheels and tools of every machine, and a few sums of the soil. The world
/// must outlive the lists. Called once, by the world itself, before any sampler adds its own.
void add_channels(World& world, Inputs& inputs, Outputs& outputs);

/// Pose, velocity and angular velocity of a link of `machine`, unless they are there already.
void add_link(const LinkHandle& link, const std::string& machine, Outputs& outputs);

/// What `navvy channels` prints: inputs, outputs and arrays with unit and meaning, one a line; of
/// arrays also element type, shape, frame and rate.
std::string channel_list(const World& world);

}  // namespace navvy::sim
