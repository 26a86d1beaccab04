// SPDX-License-Identifier: Apache-2.0
// Channels of a machine as a body: pose of its base and links, wheels, stability.
#include <algorithm>

#include "sim/channels/part_channels.h"
#include "sim/world.h"

namespace navvy::sim {

void add_base_channels(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  // Only kinematic machines with a free base can be placed; the others move by forces or not at
  // all.
  if (!built.kinematic || built.fixed_base) return;
  // Each input changes one value of the target and leaves the others.
  const auto change = [&](const std::string& name, const char* unit, const std::string& meaning,
                          auto&& part) {
    out.inputs.add({out.prefix + "pose/" + name, unit, meaning, out.machine.index()},
                   [&world = out.world, machine = out.machine, part](double value) {
                     vehicle::BaseInput command = machine.base();
                     // Snapshots accept goals up to limits::kFarthest, ten times as far.
                     part(command) =
                         std::clamp(value, -MachineCommands::kFarthest, MachineCommands::kFarthest);
                     command.duration = std::max(0.0, command.duration);
                     world.commands().set(machine, command);
                   });
  };
  const char* angles[] = {"roll", "pitch", "yaw"};
  for (int i = 0; i < 3; ++i)
    change(kAxisNames[i], "m", "position of the base link in the world; overrides the drive",
           [i](vehicle::BaseInput& command) -> double& { return command.p_W[i]; });
  for (int i = 0; i < 3; ++i)
    change(angles[i], "rad", "fixed-axis angle of the base link; overrides the drive",
           [i](vehicle::BaseInput& command) -> double& { return command.angles[i]; });
  change("duration", "s", "time of the motion to a new pose at constant velocity, 0: one step",
         [](vehicle::BaseInput& command) -> double& { return command.duration; });
}

// One channel per axis, since a channel is one number.
void add_pose_channels(const LinkHandle& link, const std::string& prefix,
                       const std::string& link_name, Outputs& outputs) {
  for (int i = 0; i < 3; ++i) {
    outputs.add(
        {prefix + "pose/" + kAxisNames[i], "m", "position of " + link_name + " in the world"},
        [link, i] { return link.pose().translation()[i]; });
    outputs.add(
        {prefix + "velocity/" + kAxisNames[i], "m/s", "velocity of " + link_name + "'s origin"},
        [link, i] { return link.velocity()[i]; });
  }
  // Fixed-axis angles, yaw about z of W last. Not unwrapped: yaw jumps by a turn.
  const char* angles[][2] = {{"pose/roll", "fixed-axis roll angle"},
                             {"pose/pitch", "fixed-axis pitch angle, positive nose down"},
                             {"pose/yaw", "heading, counter-clockwise from x"}};
  for (int i = 0; i < 3; ++i)
    outputs.add({prefix + angles[i][0], "rad", angles[i][1]},
                [link, i] { return fixed_angles(link.pose().linear())[i]; });
}

// Forces in all axes are in the handle's state.
void add_wheel_channels(const MachineChannels& out) {
  for (std::size_t i = 0; i < out.machine.description().wheels.size(); ++i) {
    const WheelHandle wheel = out.machine.wheel(static_cast<int>(i));
    const std::string base = out.prefix + wheel.name() + "/";
    out.outputs.add({base + "spin", "rad/s", "wheel speed"},
                    [wheel] { return wheel.state().spin; });
    out.outputs.add({base + "slip", "1", "longitudinal slip"},
                    [wheel] { return wheel.state().slip; });
    out.outputs.add({base + "load", "N", "vertical tyre force"},
                    [wheel] { return wheel.state().force_W.z(); });
  }
}

// Machines that cannot tip have no such channels.
void add_stability_channels(const MachineChannels& out) {
  const MachineHandle machine = out.machine;
  // A fixed base cannot tip.
  if (!machine.stability().free) return;
  const std::string base = out.prefix + "stability/";
  out.outputs.add({base + "tilt", "rad", "angle of the base link's z axis from the vertical"},
                  [machine] { return machine.stability().tilt; });
  out.outputs.add({base + "margin", "m",
                   "distance of the centre of mass, without soil, inside the nearest edge of its "
                   "support polygon; negative outside"},
                  [machine] { return machine.stability().margin; });
  // Without a bucket no pin can be loaded.
  if (machine.description().joint_index(machine.description().arm.bucket) < 0) return;
  out.outputs.add({base + "tipping_load", "kg",
                   "load on the bucket's pin that tips it over its weakest edge; 1e6 if none can"},
                  [machine] { return machine.stability().tipping_load; });
  out.outputs.add(
      {base + "tipping_heading", "rad", "direction of that edge from ahead, positive to the left"},
      [machine] { return machine.stability().tipping_heading; });
  out.outputs.add({base + "loaded_margin", "m",
                   "as margin, for the centre of pressure on the ground: with soil and loads"},
                  [machine] { return machine.stability().loaded_margin; });
}

}  // namespace navvy::sim
