// SPDX-License-Identifier: Apache-2.0
#include "sim/world_channels.h"

#include <cstdio>

#include "sim/channels/part_channels.h"
#include "sim/world.h"

namespace navvy::sim {

// Telemetry's columns and the lines of `navvy channels` follow this order.
void add_channels(World& world, Inputs& inputs, Outputs& outputs) {
  const ChannelLists lists{world, inputs, outputs};
  outputs.add({"time", "s", "simulated time"}, [&world] { return world.time(); });
  add_soil_channels(lists);
  for (int m = 0; m < world.machines().count(); ++m) {
    const MachineHandle machine = world.machines().at(m);
    const MachineChannels of{lists, machine, machine.name() + "/"};
    add_joint_channels(of);
    add_pump_channels(of);
    add_drive_channels(of);
    add_base_channels(of);
    add_lever_channels(of);
    add_pose_channels(machine.link(0), of.prefix, "the base link", outputs);
    add_wheel_channels(of);
    add_stability_channels(of);
    add_encoder_channels(of);
    add_steering_channels(of);
    add_shaft_channels(of);
    add_force_channels(of);
  }
  // Tools come after all machines, as users' scripts expect.
  for (const ToolHandle& tool : world.machines().tools()) add_tool_channels(tool, lists);
  add_hitch_channels(lists);
}

// The first name decides whether the link is declared already.
void add_link(const LinkHandle& link, const std::string& machine, Outputs& outputs) {
  const std::string prefix = machine + "/" + link.name() + "/";
  if (outputs.find(prefix + "pose/x") >= 0) return;
  add_pose_channels(link, prefix, "link '" + link.name() + "'", outputs);
  for (int i = 0; i < 3; ++i)
    outputs.add({prefix + "angular_velocity/" + kAxisNames[i], "rad/s",
                 "angular velocity of link '" + link.name() + "', world axes"},
                [link, i] { return link.angular_velocity()[i]; });
}

std::string channel_list(const World& world) {
  std::string out;
  // One line per channel: a long meaning is cut.
  char line[512];
  const auto add = [&](const std::string& name, const std::string& unit,
                       const std::string& meaning) {
    std::snprintf(line, sizeof line, "  %-44s [%s]  %s\n", name.c_str(), unit.c_str(),
                  meaning.c_str());
    out += line;
  };
  out += "inputs:\n";
  for (const Channel& channel : world.inputs()) add(channel.name, channel.unit, channel.meaning);
  out += "outputs:\n";
  for (const Channel& channel : world.outputs()) add(channel.name, channel.unit, channel.meaning);
  // Scenes without sensors have no such heading.
  if (world.arrays().channels().empty()) return out;
  out += "arrays:\n";
  for (const ArrayChannel& channel : world.arrays().channels()) {
    char rate[32] = "every step";
    if (channel.rate > 0) std::snprintf(rate, sizeof rate, "%g Hz", channel.rate);
    add(channel.name, channel.unit,
        channel.type_text() + " in " + channel.frame + ", " + rate + "  " + channel.meaning);
  }
  return out;
}

}  // namespace navvy::sim
