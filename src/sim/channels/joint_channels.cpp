// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "core/log.h"
#include "sim/channels/part_channels.h"
#include "sim/world.h"

namespace navvy::sim {
namespace {

using scene::Joint;
using vehicle::JointMode;

/// Range of a joint's input; servos and kinematic joints clamp a target to it.
struct InputRange {
  double lower, upper;
};

/// One of the three inputs of a joint.
struct JointChannel {
  const char* name;
  const char* unit;
  JointMode mode;
  InputRange range;
};

/// Makes the function of a joint's input. A target outside the range is logged once per input.
std::function<void(double)> joint_input(World& world, const JointHandle& handle,
                                        const JointChannel& about, const std::string& name) {
  // Programs allow the same slack, for rounded degrees.
  constexpr double kSlack = 1e-6;
  return [&world, handle, mode = about.mode, range = about.range, name,
          unit = std::string(about.unit), logged = false](double target) mutable {
    // The target is passed on as it is, since the physics engine clamps it.
    world.commands().set(handle, {mode, target});
    if (logged || (target >= range.lower - kSlack && target <= range.upper + kSlack)) return;
    logged = true;
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(),
                  ": %.6g %s is beyond the joint's limits, %.6g to %.6g %s", target, unit.c_str(),
                  range.lower, range.upper, unit.c_str());
    log_warning("input " + name + text.data() + "; the limit is used (logged once per input)");
  };
}

/// Declares target and measured values. The input that was set last selects the joint's mode.
void add_motion(const MachineChannels& out, const Joint& joint, const JointHandle& handle) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const bool linear = joint.type == Joint::Type::kPrismatic;
  // Without limits nothing is out of range, so nothing is logged.
  const InputRange position =
      joint.has_limits ? InputRange{joint.lower, joint.upper} : InputRange{-kFar, kFar};
  const JointChannel channels[] = {
      {"position", linear ? "m" : "rad", JointMode::kPosition, position},
      {"velocity",
       linear ? "m/s" : "rad/s",
       JointMode::kVelocity,
       {-joint.velocity, joint.velocity}},
      {"effort", linear ? "N" : "N m", JointMode::kEffort, {-joint.effort, joint.effort}}};
  const std::string base = out.prefix + joint.name + "/";
  const std::vector<scene::JointGear>& gears = out.machine.description().gears;
  const bool led = std::any_of(gears.begin(), gears.end(), [&](const scene::JointGear& gear) {
    return gear.follower == handle.index();
  });
  // Its leader alone moves a follower.
  for (const JointChannel& each : channels)
    if (!led)
      out.inputs.add({base + each.name, each.unit, "target; setting it selects this mode",
                      out.machine.index(), each.range.lower, each.range.upper, true},
                     joint_input(out.world, handle, each, base + each.name));
  out.outputs.add({base + "position", channels[0].unit, "joint position"},
                  [handle] { return handle.position(); });
  out.outputs.add({base + "velocity", channels[1].unit, "joint velocity"},
                  [handle] { return handle.velocity(); });
  out.outputs.add({base + "effort", channels[2].unit, "effort applied in the last step"},
                  [handle] { return handle.effort(); });
}

}  // namespace

// Names and types come from the data, values from the handle: no name is looked up in a step.
void add_joint_channels(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  for (std::size_t i = 0; i < built.joints.size(); ++i) {
    const Joint& joint = built.joints[i];
    // Fixed and ball joints have no servo and no position of one number.
    if (joint.type == Joint::Type::kFixed || joint.type == Joint::Type::kBall) continue;
    const JointHandle handle = out.machine.joint(static_cast<int>(i));
    add_motion(out, joint, handle);
    const std::string base = out.prefix + joint.name + "/";
    if (joint.brake > 0) {
      out.inputs.add(
          {base + "brake", "1", "1 holds the joint against any command, 0 releases it",
           out.machine.index(), 0, 1, true},
          [&world = out.world, handle](double on) { world.commands().set_brake(handle, on != 0); });
      out.outputs.add({base + "brake", "1", "1 while its brake is set"},
                      [handle] { return handle.state().braked ? 1.0 : 0.0; });
    }
    // Zeros on other joints would suggest a cylinder without load.
    if (std::any_of(built.cylinders.begin(), built.cylinders.end(),
                    [&](const scene::Cylinder& c) { return c.joint == joint.name; }))
      out.outputs.add({base + "cylinder_force", "N", "force of the cylinder on this joint"},
                      [handle] { return handle.state().cylinder_force; });
  }
}

}  // namespace navvy::sim
