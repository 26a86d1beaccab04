// SPDX-License-Identifier: Apache-2.0
#include "sim/channels/part_channels.h"
#include "sim/world.h"

namespace navvy::sim {
namespace {

/// Declares forces of soil and rock on the tool, axes of W.
void add_forces(const ToolHandle& tool, const std::string& base, bool rock, Outputs& outputs) {
  for (int i = 0; i < 3; ++i) {
    const std::string axis = kAxisNames[i];
    outputs.add(
        {base + "force_" + axis, "N",
         "force of the soil on the tool, mean over the last completed transfer, world axes"},
        [tool, i] { return tool.force()[i]; });
    outputs.add({base + "edge_force_" + axis, "N",
                 "part of that force on the edges of the tool's plates and on its teeth"},
                [tool, i] { return tool.edge_force()[i]; });
    outputs.add(
        {base + "moment_" + axis, "N m",
         "moment of the soil on the tool about the link's origin, the same mean, world axes"},
        [tool, i] { return tool.moment()[i]; });
    outputs.add({base + "smooth_force_" + axis, "N", "force of the soil, low-passed at 3 Hz"},
                [tool, i] { return tool.smooth_force()[i]; });
    if (rock)
      outputs.add(
          {base + "rock_force_" + axis, "N", "force of the rock on the tool, low-passed at 3 Hz"},
          [tool, i] { return tool.rock_force()[i]; });
  }
}

/// Declares position and velocity of the middle of a bucket's cutting edge.
void add_tip(const LinkHandle& link, const Vec3& p_tip, const std::string& base, Outputs& outputs) {
  for (int i = 0; i < 3; ++i) {
    outputs.add({base + "tip_" + kAxisNames[i], "m",
                 "position of the middle of the cutting edge in the world"},
                [link, p_tip, i] { return (link.pose() * p_tip)[i]; });
    outputs.add({base + "tip_velocity_" + kAxisNames[i], "m/s",
                 "velocity of the middle of the cutting edge, world axes"},
                [link, p_tip, i] {
                  const vehicle::LinkState at = link.state();
                  return Vec3(at.v_WL + at.w_WL.cross(at.X_WL.linear() * p_tip))[i];
                });
  }
}

}  // namespace

// The tip belongs to the bucket of this shell, if there is one.
void add_tool_channels(const ToolHandle& tool, const ChannelLists& out) {
  const MachineHandle machine = out.world.machines().at(tool.machine());
  const std::string base = machine.name() + "/" + tool.name() + "/";
  // Rock pushes back on dynamic machines only.
  add_forces(tool, base, !machine.description().kinematic, out.outputs);
  // The one output that costs time to read.
  out.outputs.add({base + "payload", "kg",
                   "soil inside the shell; a bed's without the soil in a bucket inside it"},
                  [tool] { return tool.payload(); });
  for (const scene::Bucket& bucket : machine.description().buckets)
    if (bucket.shell == tool.name())
      add_tip(machine.link(bucket.link), bucket.p_tip, base, out.outputs);
}

}  // namespace navvy::sim
