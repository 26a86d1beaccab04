// SPDX-License-Identifier: Apache-2.0
// Functions that declare the channels (named inputs and outputs) of one kind of part each.
// sim/world_channels.cpp calls them in the order in which telemetry shows the channels.
#pragma once

#include <string>

#include "sim/channels.h"
#include "sim/handles.h"

namespace navvy::sim {

class World;

/// A world and the two lists in which its parts declare their channels. The declared channels keep
/// references to the world, so the world must outlive both lists.
struct ChannelLists {
  /// World whose parts the channels read and command.
  World& world;
  /// List that receives the inputs.
  Inputs& inputs;
  /// List that receives the outputs.
  Outputs& outputs;
};

/// A world, its channel lists, and the machine whose channels are declared.
struct MachineChannels : ChannelLists {
  /// Machine whose channels are declared.
  MachineHandle machine;
  /// Start of each channel name: the machine's name and a slash.
  std::string prefix;
};

/// Names of the axes of W in channel names, by axis index.
inline constexpr const char* kAxisNames[] = {"x", "y", "z"};

/// Declares an output for the number of active particles.
void add_soil_channels(const ChannelLists& out);
/// Declares inputs and outputs for position, velocity and effort of every joint and for its brake,
/// and an output for the force of its cylinder.
void add_joint_channels(const MachineChannels& out);
/// Declares outputs for flow and pressure of the pump that feeds the machine's cylinders.
void add_pump_channels(const MachineChannels& out);
/// Declares inputs for the hydraulic levers that an operator moves by hand.
void add_lever_channels(const MachineChannels& out);
/// Declares inputs for speed, steering, brake, gear and motor speed of the machine's drive.
void add_drive_channels(const MachineChannels& out);
/// Declares an output for the steering error of a drive with a tie rod: the difference between the
/// outer wheel's angle and the ideal one.
void add_steering_channels(const MachineChannels& out);
/// Declares outputs for speeds and torques of the combustion engine, the differentials and the half
/// shafts.
void add_shaft_channels(const MachineChannels& out);
/// Declares inputs for the target pose of a kinematic machine's base link.
void add_base_channels(const MachineChannels& out);
/// Declares outputs for pose and velocity of a link. `prefix` is the start of the channel names;
/// `link_name` is the name of the link in the channel descriptions.
void add_pose_channels(const LinkHandle& link, const std::string& prefix,
                       const std::string& link_name, Outputs& outputs);
/// Declares outputs for spin, slip and load of every wheel.
void add_wheel_channels(const MachineChannels& out);
/// Declares outputs for tilt, margin and tipping load of a machine that can tip over.
void add_stability_channels(const MachineChannels& out);
/// Declares an output for the counts of every encoder, and inputs for its errors: slip and missed
/// counts.
void add_encoder_channels(const MachineChannels& out);
/// Declares inputs for the forces on all links with a force input.
void add_force_channels(const MachineChannels& out);
/// Declares outputs for soil forces, rock forces and payload of a tool and, for a bucket, the
/// position and velocity of its tip.
void add_tool_channels(const ToolHandle& tool, const ChannelLists& out);
/// Declares inputs and outputs for every hitch: closed or open, distance of the eye from the hook,
/// and force. The names start with the name of the towed machine.
void add_hitch_channels(const ChannelLists& out);

}  // namespace navvy::sim
