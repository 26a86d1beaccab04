// SPDX-License-Identifier: Apache-2.0
#include "sim/world_channels.h"

#include <algorithm>
#include <cmath>

#include "core/edit_distance.h"
#include "core/error.h"
#include "sim/world.h"

namespace navvy::sim {
namespace {

using scene::Joint;
using vehicle::JointMode;

void add_joints(World& world, int m, const std::string& prefix, Inputs& inputs, Outputs& outputs) {
  const scene::Machine& machine = world.description().machines[static_cast<std::size_t>(m)].machine;
  for (std::size_t i = 0; i < machine.joints.size(); ++i) {
    const Joint& joint = machine.joints[i];
    if (joint.type == Joint::Type::kFixed || joint.type == Joint::Type::kBall) continue;
    const bool linear = joint.type == Joint::Type::kPrismatic;
    const bool has_cylinder = std::any_of(machine.cylinders.begin(), machine.cylinders.end(),
                                          [&](const scene::Cylinder& c) { return c.joint == joint.name; });
    const int j = static_cast<int>(i);
    const std::string base = prefix + joint.name + "/";
    const struct {
      const char* name;
      const char* unit;
      JointMode mode;
    } modes[] = {{"position", linear ? "m" : "rad", JointMode::kPosition},
                 {"velocity", linear ? "m/s" : "rad/s", JointMode::kVelocity},
                 {"effort", linear ? "N" : "N m", JointMode::kEffort}};
    for (const auto& mode : modes)
      inputs.add({base + mode.name, mode.unit, "target; choosing it selects this mode"},
                 [&world, m, j, kind = mode.mode](double v) {
                   world.set_joint(m, j, {kind, v});
                 });
    outputs.add({base + "position", linear ? "m" : "rad", "joint position"},
                [&world, m, j] { return world.joint(m, j).position; });
    outputs.add({base + "velocity", linear ? "m/s" : "rad/s", "joint velocity"},
                [&world, m, j] { return world.joint(m, j).velocity; });
    outputs.add({base + "effort", linear ? "N" : "N m", "as applied in the last step"},
                [&world, m, j] { return world.joint(m, j).effort; });
    if (has_cylinder)
      outputs.add({base + "cylinder_force", "N", "of the cylinder on this joint"},
                  [&world, m, j] { return world.joint(m, j).cylinder_force; });
  }
}

void add_pump(World& world, int m, const std::string& prefix, Outputs& outputs) {
  outputs.add({prefix + "pump/flow", "m3/s", "oil that the cylinders took in the last step"},
              [&world, m] { return world.pump(m).flow; });
  outputs.add({prefix + "pump/pressure", "Pa", "of the heaviest load it moves, smoothed"},
              [&world, m] { return world.pump(m).pressure; });
}

void add_drive(World& world, int m, const scene::Drive& about, const std::string& prefix, Inputs& inputs) {
  // One value of the command changes, the others stay what the engine has: it keeps them through a snapshot.
  const auto change = [&world, m](auto&& what) {
    vehicle::DriveInput command = world.drive(m);
    what(command);
    world.set_drive(m, command);
  };
  inputs.add({prefix + "drive/speed", "m/s", "forward speed; releases the brake"}, [change](double v) {
    change([v](vehicle::DriveInput& command) {
      command.speed = v;
      command.brake = false;
    });
  });
  inputs.add({prefix + "drive/steer", scene::steer_unit(about), scene::steer_meaning(about)},
             [change](double v) { change([v](vehicle::DriveInput& command) { command.steer = v; }); });
  inputs.add({prefix + "drive/brake", "1", "1 holds the place, 0 releases"},
             [change](double v) { change([v](vehicle::DriveInput& command) { command.brake = v != 0; }); });
}

void add_pose(World& world, int m, const std::string& prefix, Outputs& outputs) {
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    outputs.add({prefix + "pose/" + axes[i], "m", "of the base link in the world"},
                [&world, m, i] { return world.link(m, 0).X_WL.translation()[i]; });
    outputs.add({prefix + "velocity/" + axes[i], "m/s", "of the base link's origin"},
                [&world, m, i] { return world.link(m, 0).v_WL[i]; });
  }
  outputs.add({prefix + "pose/roll", "rad", "fixed-axis roll"}, [&world, m] {
    const Mat3 R = world.link(m, 0).X_WL.linear();
    return std::atan2(R(2, 1), R(2, 2));
  });
  outputs.add({prefix + "pose/pitch", "rad", "fixed-axis pitch, positive nose down"},
              [&world, m] { return std::asin(std::clamp(-world.link(m, 0).X_WL.linear()(2, 0), -1.0, 1.0)); });
  outputs.add({prefix + "pose/yaw", "rad", "heading, counter-clockwise from x"}, [&world, m] {
    const Mat3 R = world.link(m, 0).X_WL.linear();
    return std::atan2(R(1, 0), R(0, 0));
  });
}

void add_wheels(World& world, int m, const std::string& prefix, Outputs& outputs) {
  const scene::Machine& machine = world.description().machines[static_cast<std::size_t>(m)].machine;
  for (std::size_t i = 0; i < machine.wheels.size(); ++i) {
    const int w = static_cast<int>(i);
    const std::string base = prefix + machine.wheels[i].joint + "/";
    outputs.add({base + "spin", "rad/s", "wheel speed"}, [&world, m, w] { return world.wheel(m, w).spin; });
    outputs.add({base + "slip", "1", "longitudinal slip"}, [&world, m, w] { return world.wheel(m, w).slip; });
    outputs.add({base + "load", "N", "vertical tyre force"}, [&world, m, w] { return world.wheel(m, w).force_W.z(); });
  }
}

void add_tools(World& world, const std::vector<std::string>& prefixes, Outputs& outputs) {
  const auto& tools = world.coupling().tools();
  const char* axes[] = {"x", "y", "z"};
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const auto m = static_cast<std::size_t>(tools[t].machine);
    const scene::Machine& machine = world.description().machines[m].machine;
    const std::string base = prefixes[m] + machine.shells[static_cast<std::size_t>(tools[t].shell)].name + "/";
    for (int i = 0; i < 3; ++i) {
      outputs.add({base + "force_" + axes[i], "N", "soil on the tool, mean of the last step, world axes"},
                  [&world, t, i] { return world.coupling().tools()[t].force_W[i]; });
      outputs.add({base + "moment_" + axes[i], "N m", "soil on the tool about the link's origin, world axes"},
                  [&world, t, i] { return world.coupling().tools()[t].moment_W[i]; });
      outputs.add({base + "smooth_force_" + axes[i], "N", "the force, low-passed at 3 Hz"},
                  [&world, t, i] { return world.coupling().tools()[t].smooth_W[i]; });
      if (!machine.kinematic)
        outputs.add({base + "rock_force_" + axes[i], "N", "rock on the tool, low-passed at 3 Hz"},
                    [&world, t, i] { return world.coupling().tools()[t].rock_W[i]; });
    }
    outputs.add({base + "payload", "kg", "soil inside the shell; of a bed without what a bucket holds in it"},
                [&world, t] { return world.coupling().payload(world.coupling().tools()[t]); });
  }
}

}  // namespace

void add_channels(World& world, Inputs& inputs, Outputs& outputs) {
  outputs.add({"time", "s", "simulated time"}, [&world] { return world.time(); });
  outputs.add({"soil/particles", "1", "awake particles"},
              [&world] { return static_cast<double>(world.soil().stats().particles); });
  std::vector<std::string> prefixes;
  for (std::size_t i = 0; i < world.description().machines.size(); ++i) {
    const int m = static_cast<int>(i);
    prefixes.push_back(world.description().machines[i].name + "/");
    add_joints(world, m, prefixes.back(), inputs, outputs);
    const scene::Machine& machine = world.description().machines[i].machine;
    if (machine.has_pump && !machine.kinematic) add_pump(world, m, prefixes.back(), outputs);
    if (machine.has_drive) add_drive(world, m, machine.drive, prefixes.back(), inputs);
    add_pose(world, m, prefixes.back(), outputs);
    add_wheels(world, m, prefixes.back(), outputs);
  }
  add_tools(world, prefixes, outputs);
}

std::string nearest_name(const std::vector<Channel>& channels, const std::string& name) {
  std::string best;
  std::size_t least = static_cast<std::size_t>(-1);
  for (const Channel& channel : channels) {
    const std::size_t distance = edit_distance(channel.name, name);
    if (distance < least) least = distance, best = channel.name;
  }
  return best;
}

int require_channel(int found, const std::vector<Channel>& channels, const std::string& name, const std::string& kind) {
  if (found >= 0) return found;
  throw InputError(Fault{Fault::Severity::kError, "", 0, kind, name, "there is no " + kind + " of this name",
                         "did you mean '" + nearest_name(channels, name) + "'?"});
}

}  // namespace navvy::sim
