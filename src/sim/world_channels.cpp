// SPDX-License-Identifier: Apache-2.0
#include "sim/world_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/log.h"
#include "sim/world.h"
#include "sim/world_parts.h"
#include "vehicle/drive/drive_line.h"
#include "vehicle/drive/linkage.h"
#include "vehicle/levers.h"

namespace navvy::sim {
namespace {

using scene::Joint;
using vehicle::JointMode;

/// What a joint's input takes: all beyond these bounds goes to the nearer one.
struct Bounds {
  double lower, upper;
};

/// The function of a joint's input. A target beyond the joint's limits is told, once an input:
/// servos and kinematic joints stop at the limit.
std::function<void(double)> joint_input(World& world, const JointHandle& handle, JointMode mode,
                                        const Bounds& bounds, const std::string& name,
                                        const std::string& unit) {
  // Rounding of degrees is let pass, as in programs.
  constexpr double kSlack = 1e-6;
  return [&world, handle, mode, bounds, name, unit, told = false](double target) mutable {
    world.command(handle, {mode, target});
    if (told || (target >= bounds.lower - kSlack && target <= bounds.upper + kSlack)) return;
    told = true;
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(),
                  ": %.6g %s is beyond the joint's limits, %.6g to %.6g %s", target, unit.c_str(),
                  bounds.lower, bounds.upper, unit.c_str());
    log_warning("input " + name + text.data() + ": it goes to the limit (said once an input)");
  };
}

/// Three inputs a joint, of which the one that was set last decides its mode; fixed and ball joints
/// have no servo.
void add_joints(World& world, const MachineHandle& machine, const std::string& prefix,
                Inputs& inputs, Outputs& outputs) {
  // Names and types come from the data, values from the handle.
  const scene::Machine& built = machine.description();
  for (std::size_t i = 0; i < built.joints.size(); ++i) {
    const Joint& joint = built.joints[i];
    // Neither has a position of one number.
    if (joint.type == Joint::Type::kFixed || joint.type == Joint::Type::kBall) continue;
    // Prismatic joints count in metres.
    const bool linear = joint.type == Joint::Type::kPrismatic;
    const bool has_cylinder =
        std::any_of(built.cylinders.begin(), built.cylinders.end(),
                    [&](const scene::Cylinder& c) { return c.joint == joint.name; });
    const JointHandle handle = machine.joint(static_cast<int>(i));
    const std::string base = prefix + joint.name + "/";
    // The units follow the joint's type. A closure holds a handle: no name is looked up while
    // stepping.
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const struct {
      const char* name;
      const char* unit;
      JointMode mode;
      Bounds bounds;
    } modes[] = {
        {"position", linear ? "m" : "rad", JointMode::kPosition,
         joint.has_limits ? Bounds{joint.lower, joint.upper} : Bounds{-kFar, kFar}},
        {"velocity",
         linear ? "m/s" : "rad/s",
         JointMode::kVelocity,
         {-joint.velocity, joint.velocity}},
        {"effort", linear ? "N" : "N m", JointMode::kEffort, {-joint.effort, joint.effort}}};
    for (const auto& mode : modes)
      inputs.add(
          {base + mode.name, mode.unit, "target; choosing it selects this mode", machine.index()},
          joint_input(world, handle, mode.mode, mode.bounds, base + mode.name, mode.unit));
    // A joint's inputs and outputs have the same names: one is the target, the other what it came
    // to.
    outputs.add({base + "position", linear ? "m" : "rad", "joint position"},
                [handle] { return handle.position(); });
    outputs.add({base + "velocity", linear ? "m/s" : "rad/s", "joint velocity"},
                [handle] { return handle.velocity(); });
    outputs.add({base + "effort", linear ? "N" : "N m", "as applied in the last step"},
                [handle] { return handle.effort(); });
    if (joint.brake > 0) {
      inputs.add({base + "brake", "1", "1 holds the joint whatever it is told, 0 lets go",
                  machine.index()},
                 [&world, handle](double on) { world.brake(handle, on != 0); });
      outputs.add({base + "brake", "1", "1 while its brake is on"},
                  [handle] { return handle.state().braked ? 1.0 : 0.0; });
    }
    // Only where it means something: a column of zeros would suggest a cylinder without load.
    if (has_cylinder)
      outputs.add({base + "cylinder_force", "N", "of the cylinder on this joint"},
                  [handle] { return handle.state().cylinder_force; });
  }
}

/// One pump feeds all cylinders of a machine.
void add_pump(const MachineHandle& machine, const std::string& prefix, Outputs& outputs) {
  // Flow and pressure tell which of its limits holds a cylinder back.
  outputs.add({prefix + "pump/flow", "m3/s", "oil that the cylinders took in the last step"},
              [machine] { return machine.pump().flow; });
  outputs.add({prefix + "pump/pressure", "Pa", "of the heaviest load it moves, smoothed"},
              [machine] { return machine.pump().pressure; });
}

/// The paper's six numbers: an obstacle, a person, a machine that is replayed.
void add_base(World& world, const MachineHandle& machine, const std::string& prefix,
              Inputs& inputs) {
  // One value changes, the others stay what they were told or, before, where the base is.
  const auto change = [&](const std::string& name, const char* unit, const std::string& meaning,
                          auto&& part) {
    inputs.add({prefix + "pose/" + name, unit, meaning, machine.index()},
               [&world, machine, part](double value) {
                 vehicle::BaseInput command = machine.base();
                 part(command) = std::clamp(value, -World::kFarthest, World::kFarthest);
                 command.duration = std::max(0.0, command.duration);
                 world.command(machine, command);
               });
  };
  const char* axes[] = {"x", "y", "z"};
  const char* angles[] = {"roll", "pitch", "yaw"};
  for (int i = 0; i < 3; ++i)
    change(axes[i], "m", "of the base link in the world; takes it from the drive",
           [i](vehicle::BaseInput& command) -> double& { return command.p_W[i]; });
  for (int i = 0; i < 3; ++i)
    change(angles[i], "rad", "fixed-axis, of the base link; takes it from the drive",
           [i](vehicle::BaseInput& command) -> double& { return command.angles[i]; });
  change("duration", "s", "it gets to a new place evenly within this time, 0: in a step",
         [](vehicle::BaseInput& command) -> double& { return command.duration; });
}

/// @throws InputError for a number that is none of a gear.
int whole_gear(const std::string& name, double value) {
  if (value == std::floor(value) && std::abs(value) < 1000) return static_cast<int>(value);
  throw InputError(Fault{Fault::Severity::kError, "", 0, "input " + name, std::to_string(value),
                         "a gear is a whole number", "give 1 for the first, 0: it chooses"});
}

/// `about` tells what steering means for this kind of drive.
void add_drive(World& world, const MachineHandle& machine, const scene::Drive& about,
               const std::string& prefix, Inputs& inputs) {
  // One value of the command changes, the others stay what the engine has: it keeps them through a
  // snapshot.
  const auto change = [&world, machine](auto&& what) {
    vehicle::DriveInput command = machine.drive();
    what(command);
    world.command(machine, command);
  };
  // A speed says that the machine shall move, so the brake goes.
  inputs.add({prefix + "drive/speed", "m/s", "forward speed; releases the brake", machine.index()},
             [change](double v) {
               change([v](vehicle::DriveInput& command) {
                 command.speed = v;
                 command.brake = false;
               });
             });
  inputs.add(
      {prefix + "drive/steer", scene::steer_unit(about), scene::steer_meaning(about),
       machine.index()},
      [change](double v) { change([v](vehicle::DriveInput& command) { command.steer = v; }); });
  inputs.add({prefix + "drive/brake", "1", "1 holds the place, 0 releases", machine.index()},
             [change](double v) {
               change([v](vehicle::DriveInput& command) { command.brake = v != 0; });
             });
  const scene::CombustionEngine* engine = scene::drive_engine(about);
  if (engine == nullptr) return;
  const bool source = engine->kind == scene::CombustionEngine::Kind::kSpeedSource;
  const std::string gears = "1 to " + std::to_string(engine->gears.size());
  inputs.add({prefix + "drive/gear", "1", gears + (source ? ", 0: the first" : ", 0: it chooses"),
              machine.index()},
             [change, name = prefix + "drive/gear"](double v) {
               change([&](vehicle::DriveInput& command) { command.gear = whole_gear(name, v); });
             });
  if (!source) return;
  // Of the unloaded wheels: a tyre's deflection is no controller's knowledge.
  double radius = 0;
  int driven = 0;
  for (const scene::Wheel& wheel : machine.description().wheels)
    if (wheel.driven) radius += wheel.radius, ++driven;
  radius /= std::max(driven, 1);
  inputs.add(
      {prefix + "drive/motor_speed", "rad/s", "of the motor; releases the brake", machine.index()},
      [change, radius, ratios = engine->gears, last = engine->final_ratio](double v) {
        change([&](vehicle::DriveInput& command) {
          command.speed =
              v * radius / (last * ratios[static_cast<std::size_t>(std::max(command.gear, 1) - 1)]);
          command.brake = false;
        });
      });
}

/// What a real robot's board gives, and the ways in which it may be told to fail. A fault is
/// nobody's command, so it takes no machine from its program.
void add_encoders(World& world, const MachineHandle& machine, const std::string& prefix,
                  Inputs& inputs, Outputs& outputs) {
  vehicle::Encoders& encoders = parts(world).encoders[static_cast<std::size_t>(machine.index())];
  for (std::size_t i = 0; i < encoders.size(); ++i) {
    vehicle::JointEncoder* encoder = &encoders[i];
    const std::string base = prefix + encoder->about().joint + "/";
    const std::string bits = std::to_string(encoder->about().bits);
    outputs.add({base + "counts", "1", "encoder's register, wraps at 2^" + bits},
                [encoder] { return static_cast<double>(encoder->counts()); });
    inputs.add({base + "encoder_slip", "1", "slip that the counts pretend, -0.9 to 0.9"},
               [encoder](double slip) { encoder->set_slip(slip); });
    inputs.add({base + "encoder_missed", "1", "share of the counts that are lost, 0 to 1"},
               [encoder](double share) { encoder->set_missed(share); });
  }
}

/// As an operator's hands have them; the pattern is the machine's.
void add_levers(World& world, const MachineHandle& machine, const std::string& prefix,
                Inputs& inputs) {
  const scene::Machine& built = machine.description();
  const vehicle::LeverFunctions functions = vehicle::lever_functions(built);
  for (std::size_t i = 0; i < functions.size(); ++i) {
    if (functions[i].joint < 0) continue;
    const JointHandle joint = machine.joint(functions[i].joint);
    const std::string way = i % 2 == 0 ? "to the right" : "away";
    inputs.add(
        {prefix + "levers/" + vehicle::kLeverNames[i], "1",
         "-1 to 1, positive " + way + "; opens the valve of " + joint.name(), machine.index()},
        [&world, joint, sign = functions[i].sign, band = built.levers.dead_band](double lever) {
          world.command(joint, {JointMode::kOpening, sign * vehicle::lever_opening(lever, band)});
        });
  }
}

/// Angles are fixed-axis roll, pitch, yaw: yaw about W z last. `of` tells the link in a channel's
/// meaning.
void add_pose(const LinkHandle& link, const std::string& prefix, const std::string& of,
              Outputs& outputs) {
  // One channel an axis: a channel is one number.
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    outputs.add({prefix + "pose/" + axes[i], "m", "of " + of + " in the world"},
                [link, i] { return link.pose().translation()[i]; });
    outputs.add({prefix + "velocity/" + axes[i], "m/s", "of " + of + "'s origin"},
                [link, i] { return link.velocity()[i]; });
  }
  // Not unwrapped: a jump of a turn is left to the reader.
  const char* angles[][2] = {{"pose/roll", "fixed-axis roll"},
                             {"pose/pitch", "fixed-axis pitch, positive nose down"},
                             {"pose/yaw", "heading, counter-clockwise from x"}};
  for (int i = 0; i < 3; ++i)
    outputs.add({prefix + angles[i][0], "rad", angles[i][1]},
                [link, i] { return fixed_angles(link.pose().linear())[i]; });
}

/// What an engineer watches of a tyre; forces in all axes are in the handle's state.
void add_wheels(const MachineHandle& machine, const std::string& prefix, Outputs& outputs) {
  for (std::size_t i = 0; i < machine.description().wheels.size(); ++i) {
    const WheelHandle wheel = machine.wheel(static_cast<int>(i));
    const std::string base = prefix + wheel.name() + "/";
    outputs.add({base + "spin", "rad/s", "wheel speed"}, [wheel] { return wheel.state().spin; });
    outputs.add({base + "slip", "1", "longitudinal slip"}, [wheel] { return wheel.state().slip; });
    outputs.add({base + "load", "N", "vertical tyre force"},
                [wheel] { return wheel.state().force_W.z(); });
  }
}

/// Of the wheels as they stand, whatever their tyres bend them to.
void add_linkage(const MachineHandle& machine, const scene::LinkageDrive& drive,
                 const std::string& prefix, Outputs& outputs) {
  std::optional<WheelHandle> left, right;
  const scene::Machine& built = machine.description();
  const std::vector<vehicle::DriveWheel> about = vehicle::drive_wheels(built);
  for (std::size_t i = 0; i < built.wheels.size(); ++i)
    if (!built.wheels[i].steer_joint.empty())
      (about[i].left ? left : right) = machine.wheel(static_cast<int>(i));
  if (!left || !right) return;
  outputs.add({prefix + "steering/ackermann_error", "rad",
               "how much further than on a common centre the outer wheel is turned, for the inner "
               "one's angle"},
              [drive, left = *left, right = *right] {
                return vehicle::ackermann_error(drive, {left.state().steer, right.state().steer});
              });
}

/// Torques and speeds of the engine's shaft, of the cage of each differential and of the half
/// shafts, whose speeds are the wheels' spins.
void add_shafts(const MachineHandle& machine, const std::string& prefix, Outputs& outputs) {
  const scene::Machine& built = machine.description();
  const bool shared = scene::powertrain(built.drive).engine_power > 0;
  if (scene::drive_engine(built.drive) != nullptr) {
    outputs.add({prefix + "engine/speed", "rad/s", "of the engine's shaft"},
                [machine] { return machine.engine().speed; });
    outputs.add({prefix + "engine/torque", "N m", "of the engine's shaft in the last step"},
                [machine] { return machine.engine().torque; });
    outputs.add({prefix + "engine/gear", "1", "that is in"},
                [machine] { return static_cast<double>(machine.engine().gear); });
  }
  if (shared || scene::drive_engine(built.drive) != nullptr)
    outputs.add(
        {prefix + "engine/power", "W", shared ? "for drive and pump together" : "for the drive"},
        [machine] { return machine.engine().power; });
  for (const vehicle::Coupled& one : vehicle::make_drive_line(built)->differentials()) {
    std::vector<std::pair<WheelHandle, double>> behind;
    for (std::size_t w = 0; w < one.weight.size(); ++w)
      if (one.weight[w] != 0)
        behind.emplace_back(machine.wheel(static_cast<int>(w)), 0.5 * std::abs(one.weight[w]));
    outputs.add({prefix + one.name + "/speed", "rad/s", "of the differential's cage"}, [behind] {
      double speed = 0;
      for (const auto& [wheel, weight] : behind) speed += weight * wheel.state().spin;
      return speed;
    });
    outputs.add(
        {prefix + one.name + "/torque", "N m", "of the differential's cage in the last step"},
        [behind] {
          double torque = 0;
          for (const auto& [wheel, weight] : behind) torque += wheel.state().shaft_torque;
          return torque;
        });
  }
  for (std::size_t w = 0; w < built.wheels.size(); ++w)
    if (built.wheels[w].driven)
      outputs.add(
          {prefix + built.wheels[w].joint + "/shaft_torque", "N m",
           "of its half shaft in the last step"},
          [wheel = machine.wheel(static_cast<int>(w))] { return wheel.state().shaft_torque; });
}

/// Only of machines that can tip: of others the numbers would say nothing.
void add_stability(const MachineHandle& machine, const std::string& prefix, Outputs& outputs) {
  if (!machine.stability().free) return;
  outputs.add({prefix + "stability/tilt", "rad", "of the base link's z axis from the vertical"},
              [machine] { return machine.stability().tilt; });
  outputs.add({prefix + "stability/margin", "m",
               "of the centre of mass, without soil, from the nearest edge between its feet; "
               "negative outside"},
              [machine] { return machine.stability().margin; });
  if (machine.description().joint_index(machine.description().arm.bucket) < 0) return;
  outputs.add({prefix + "stability/tipping_load", "kg",
               "on the bucket's pin, that tips it over its weakest edge; 1e6 where none can"},
              [machine] { return machine.stability().tipping_load; });
  outputs.add({prefix + "stability/tipping_heading", "rad",
               "towards that edge, from ahead, positive to the left"},
              [machine] { return machine.stability().tipping_heading; });
  outputs.add({prefix + "stability/loaded_margin", "m",
               "as margin, of the point where the ground bears it: with soil and loads"},
              [machine] { return machine.stability().loaded_margin; });
}

/// Forces are what soil and rock do to the tool, axes of W.
void add_tool(const World& world, const ToolHandle& tool, Outputs& outputs) {
  const MachineHandle machine = world.machine(tool.machine());
  const std::string base = machine.name() + "/" + tool.name() + "/";
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    outputs.add({base + "force_" + axes[i], "N",
                 "soil on the tool, mean of the last transfer that ended, world axes"},
                [tool, i] { return tool.force()[i]; });
    outputs.add({base + "moment_" + axes[i], "N m",
                 "soil on the tool about the link's origin, mean likewise, world axes"},
                [tool, i] { return tool.moment()[i]; });
    outputs.add({base + "smooth_force_" + axes[i], "N", "the force, low-passed at 3 Hz"},
                [tool, i] { return tool.smooth_force()[i]; });
    // Rock pushes back on machines with masses only.
    if (!machine.description().kinematic)
      outputs.add({base + "rock_force_" + axes[i], "N", "rock on the tool, low-passed at 3 Hz"},
                  [tool, i] { return tool.rock_force()[i]; });
  }
  // The one output that costs time to read.
  outputs.add(
      {base + "payload", "kg", "soil inside the shell; of a bed without what a bucket holds in it"},
      [tool] { return tool.payload(); });
  for (const scene::Bucket& bucket : machine.description().buckets) {
    if (bucket.shell != tool.name()) continue;
    const LinkHandle link = machine.link(bucket.link);
    for (int i = 0; i < 3; ++i) {
      outputs.add({base + "tip_" + axes[i], "m", "middle of the cutting edge in the world"},
                  [link, p = bucket.p_tip, i] { return (link.pose() * p)[i]; });
      outputs.add({base + "tip_velocity_" + axes[i], "m/s",
                   "of the middle of the cutting edge, world axes"},
                  [link, p = bucket.p_tip, i] {
                    const vehicle::LinkState at = link.state();
                    return Vec3(at.v_WL + at.w_WL.cross(at.X_WL.linear() * p))[i];
                  });
    }
  }
}

/// Hook and eye, told at the machine that hangs.
void add_hitches(World& world, Inputs& inputs, Outputs& outputs) {
  const std::vector<scene::Hitch>& hitches = world.description().hitches;
  for (std::size_t i = 0; i < hitches.size(); ++i) {
    const int hitch = static_cast<int>(i);
    const std::string base = world.machine(hitches[i].child).name() + "/" + hitches[i].name + "/";
    // Who is let go keeps to its program.
    inputs.add({base + "closed", "1",
                "0 lets go, 1 takes the eye up where it is within 0.1 m of the hook"},
               [&world, hitch](double closed) { world.couple(hitch, closed != 0); });
    outputs.add({base + "closed", "1", "1 while it hangs on the hook"},
                [&world, hitch] { return world.hitch(hitch).closed ? 1.0 : 0.0; });
    outputs.add({base + "apart", "m", "of the eye from the hook"},
                [&world, hitch] { return world.hitch(hitch).apart; });
    const char* axes[] = {"x", "y", "z"};
    for (int a = 0; a < 3; ++a)
      outputs.add({base + "force_" + axes[a], "N", "of what hangs on what draws it, world axes"},
                  [&world, hitch, a] { return world.hitch(hitch).force[a]; });
  }
}

}  // namespace

/// Telemetry's columns and the lines of `navvy channels` are this order: adding goes at the end of
/// a group.
void add_channels(World& world, Inputs& inputs, Outputs& outputs) {
  outputs.add({"time", "s", "simulated time"}, [&world] { return world.time(); });
  outputs.add({"soil/particles", "1", "awake particles"},
              [&world] { return static_cast<double>(world.soil_counts().particles); });
  for (int m = 0; m < world.machine_count(); ++m) {
    // Machines in the order of the scene.
    const MachineHandle machine = world.machine(m);
    const scene::Machine& built = machine.description();
    const std::string prefix = machine.name() + "/";
    add_joints(world, machine, prefix, inputs, outputs);
    // A kinematic machine moves as told and draws no oil.
    if (built.has_pump && !built.kinematic) add_pump(machine, prefix, outputs);
    if (built.has_drive) add_drive(world, machine, built.drive, prefix, inputs);
    if (built.kinematic && !built.fixed_base) add_base(world, machine, prefix, inputs);
    if (built.levers.given) add_levers(world, machine, prefix, inputs);
    add_pose(machine.link(0), prefix, "the base link", outputs);
    add_wheels(machine, prefix, outputs);
    add_stability(machine, prefix, outputs);
    add_encoders(world, machine, prefix, inputs, outputs);
    if (const auto* linkage = std::get_if<scene::LinkageDrive>(&built.drive);
        linkage && built.has_drive)
      add_linkage(machine, *linkage, prefix, outputs);
    // The motors of a differential drive are the wheels' own: the joints' efforts tell of them.
    if (built.has_drive && !built.kinematic &&
        !std::holds_alternative<scene::DifferentialDrive>(built.drive))
      add_shafts(machine, prefix, outputs);
  }
  // All tools come after all machines: telemetry's columns keep the order that users' scripts know.
  for (const ToolHandle& tool : world.tools()) add_tool(world, tool, outputs);
  add_hitches(world, inputs, outputs);
}

void add_link(const LinkHandle& link, const std::string& machine, Outputs& outputs) {
  const std::string prefix = machine + "/" + link.name() + "/";
  if (outputs.find(prefix + "pose/x") >= 0) return;
  add_pose(link, prefix, "link '" + link.name() + "'", outputs);
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    outputs.add({prefix + "angular_velocity/" + axes[i], "rad/s",
                 "of link '" + link.name() + "', world axes"},
                [link, i] { return link.angular_velocity()[i]; });
}

/// Names in a column wide enough for all shipped machines.
std::string channel_list(const World& world) {
  std::string out;
  // Long meanings are cut rather than wrapped: one channel, one line.
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
  // A scene without sensors reads as it always did.
  if (world.arrays().channels().empty()) return out;
  out += "arrays:\n";
  for (const ArrayChannel& channel : world.arrays().channels()) {
    // A rate of zero means after every step.
    char rate[32] = "every step";
    if (channel.rate > 0) std::snprintf(rate, sizeof rate, "%g Hz", channel.rate);
    add(channel.name, channel.unit,
        channel.type_text() + " in " + channel.frame + ", " + rate + "  " + channel.meaning);
  }
  return out;
}

}  // namespace navvy::sim
