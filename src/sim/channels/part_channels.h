// SPDX-License-Identifier: Apache-2.0
// Channels by part: each function declares the inputs and outputs of one part, in a file of its
// own. sim/world_channels.cpp calls them in the order that telemetry shows.
#pragma once

#include <string>

#include "sim/channels.h"
#include "sim/handles.h"

namespace navvy::sim {

class World;

/// World and lists in which a part declares its channels. Their functions keep references to the
/// world and handles, so the world must outlive both lists.
struct ChannelLists {
  World& world;
  Inputs& inputs;
  Outputs& outputs;
};

/// The same, for one machine.
struct MachineChannels : ChannelLists {
  MachineHandle machine;
  /// The machine's name and a slash, which every name of its channels starts with.
  std::string prefix;
};

/// Letters of the axes of W, by index, for names of channels.
inline constexpr const char* kAxisNames[] = {"x", "y", "z"};

/// Declares the number of active particles.
void add_soil_channels(const ChannelLists& out);
/// Declares position, velocity and effort of every joint as inputs and outputs, its brake and the
/// force of its cylinder.
void add_joint_channels(const MachineChannels& out);
/// Declares flow and pressure of the pump that feeds all cylinders.
void add_pump_channels(const MachineChannels& out);
/// Declares levers as an operator's hands move them.
void add_lever_channels(const MachineChannels& out);
/// Declares speed, steering, brake, gear and motor speed of the drive as inputs.
void add_drive_channels(const MachineChannels& out);
/// Declares the steering error of a drive with a tie rod.
void add_steering_channels(const MachineChannels& out);
/// Declares speeds and torques of the combustion engine, the differentials and the half shafts.
void add_shaft_channels(const MachineChannels& out);
/// Declares the pose of a kinematic machine's base as inputs.
void add_base_channels(const MachineChannels& out);
/// Declares pose and velocity of a link. `prefix` starts the names; `link_name` is the link in
/// their descriptions.
void add_pose_channels(const LinkHandle& link, const std::string& prefix,
                       const std::string& link_name, Outputs& outputs);
/// Declares spin, slip and load of every wheel.
void add_wheel_channels(const MachineChannels& out);
/// Declares tilt, margin and tipping load of a machine that can tip.
void add_stability_channels(const MachineChannels& out);
/// Declares counts and faults of every encoder.
void add_encoder_channels(const MachineChannels& out);
/// Declares soil forces, rock forces and payload of a tool, and the tip of a bucket.
void add_tool_channels(const ToolHandle& tool, const ChannelLists& out);
/// Declares state and force of every hitch, under the name of the machine that is towed.
void add_hitch_channels(const ChannelLists& out);

}  // namespace navvy::sim
