// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "sim/channels/part_channels.h"
#include "sim/world.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::sim {
namespace {

/// @throws InputError for a number that is not a gear's.
int whole_gear(const std::string& name, double value) {
  // The bound keeps the cast defined; MachineCommands checks which gears there are.
  if (value == std::floor(value) && std::abs(value) < 1000) return static_cast<int>(value);
  throw InputError(Fault{Fault::Severity::kError, "", 0, "input " + name, std::to_string(value),
                         "a gear is a whole number",
                         "give 1 for the first gear, or 0 for automatic"});
}

/// Returns the mean radius of the driven wheels without load [m]: a controller does not know a
/// tyre's deflection.
double driven_radius(const scene::Machine& machine) {
  double radius = 0;
  int driven = 0;
  for (const scene::Wheel& wheel : machine.wheels)
    if (wheel.driven) radius += wheel.radius, ++driven;
  return radius / std::max(driven, 1);
}

/// Returns a function that changes one value of the drive's command. The engine keeps the others,
/// also through a snapshot.
auto changing(const MachineChannels& out) {
  return [&world = out.world, machine = out.machine](auto&& change) {
    vehicle::DriveInput command = machine.drive();
    change(command);
    world.commands().set(machine, command);
  };
}

// Declares the gear, and the motor's speed for a speed source.
void add_gear(const MachineChannels& out, const scene::CombustionEngine& engine) {
  const auto change = changing(out);
  const bool source = engine.kind == scene::CombustionEngine::Kind::kSpeedSource;
  const std::string gears = "1 to " + std::to_string(engine.gears.size()),
                    name = out.prefix + "drive/gear";
  out.inputs.add(
      {name, "1", gears + (source ? ", 0: the first" : ", 0: automatic"), out.machine.index()},
      [change, name](double v) {
        change([&](vehicle::DriveInput& command) { command.gear = whole_gear(name, v); });
      });
  if (!source) return;
  out.inputs.add({out.prefix + "drive/motor_speed", "rad/s", "motor speed; releases the brake",
                  out.machine.index()},
                 [change, radius = driven_radius(out.machine.description()), ratios = engine.gears,
                  last = engine.final_ratio](double v) {
                   change([&](vehicle::DriveInput& command) {
                     // The gear of this moment converts the speed; a later change of gear leaves
                     // the speed of the machine. Gear 0 is the first.
                     const auto gear = static_cast<std::size_t>(std::max(command.gear, 1) - 1);
                     command.speed = v * radius / (last * ratios[gear]);
                     command.brake = false;
                   });
                 });
}

/// Declares the shaft of the combustion engine.
void add_engine(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  const bool shared = scene::powertrain(built.drive).engine_power > 0;
  const bool geared = scene::drive_engine(built.drive) != nullptr;
  const MachineHandle machine = out.machine;
  if (geared) {
    out.outputs.add({out.prefix + "engine/speed", "rad/s", "speed of the engine's shaft"},
                    [machine] { return machine.engine().speed; });
    out.outputs.add(
        {out.prefix + "engine/torque", "N m", "torque of the engine's shaft in the last step"},
        [machine] { return machine.engine().torque; });
    out.outputs.add({out.prefix + "engine/gear", "1", "engaged gear"},
                    [machine] { return static_cast<double>(machine.engine().gear); });
  }
  if (shared || geared)
    out.outputs.add(
        {out.prefix + "engine/power", "W",
         shared ? "engine power for drive and pump together" : "engine power for the drive"},
        [machine] { return machine.engine().power; });
}

/// Declares speed and torque of a differential's carrier, from the wheels behind it.
/// The carrier turns with half the sum of the speeds on both sides (vehicle::Coupled), and its
/// torque is the sum of theirs.
void add_differential(const MachineChannels& out, const vehicle::Coupled& one) {
  std::vector<std::pair<WheelHandle, double>> behind;
  for (std::size_t w = 0; w < one.weight.size(); ++w)
    if (one.weight[w] != 0)
      behind.emplace_back(out.machine.wheel(static_cast<int>(w)), 0.5 * std::abs(one.weight[w]));
  out.outputs.add({out.prefix + one.name + "/speed", "rad/s", "speed of the differential carrier"},
                  [behind] {
                    double speed = 0;
                    for (const auto& [wheel, weight] : behind) speed += weight * wheel.state().spin;
                    return speed;
                  });
  out.outputs.add({out.prefix + one.name + "/torque", "N m",
                   "torque of the differential carrier in the last step"},
                  [behind] {
                    double torque = 0;
                    for (const auto& [wheel, weight] : behind) torque += wheel.state().shaft_torque;
                    return torque;
                  });
}

}  // namespace

// A speed command releases the brake, since the machine is meant to move.
void add_drive_channels(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  if (!built.has_drive) return;
  const auto change = changing(out);
  out.inputs.add(
      {out.prefix + "drive/speed", "m/s", "forward speed; releases the brake", out.machine.index()},
      [change](double v) {
        change([v](vehicle::DriveInput& command) {
          command.speed = v;
          command.brake = false;
        });
      });
  out.inputs.add(
      {out.prefix + "drive/steer", scene::steer_unit(built.drive),
       scene::steer_meaning(built.drive), out.machine.index()},
      [change](double v) { change([v](vehicle::DriveInput& command) { command.steer = v; }); });
  out.inputs.add({out.prefix + "drive/brake", "1", "1 sets the brakes, 0 releases them",
                  out.machine.index(), 0, 1, true},
                 [change](double v) {
                   change([v](vehicle::DriveInput& command) { command.brake = v != 0; });
                 });
  if (const scene::CombustionEngine* engine = scene::drive_engine(built.drive))
    add_gear(out, *engine);
}

// Needs one steered wheel on each side.
void add_steering_channels(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  if (!built.has_drive) return;
  const std::shared_ptr<const vehicle::DriveLine> line = vehicle::make_drive_line(built);
  // A drive without a common centre of turning has no such error.
  if (!line->steering_error(0, 0)) return;
  std::optional<WheelHandle> left, right;
  const std::vector<vehicle::DriveWheel> about = vehicle::drive_wheels(built);
  for (std::size_t i = 0; i < built.wheels.size(); ++i)
    if (!built.wheels[i].steer_joint.empty())
      (about[i].left ? left : right) = out.machine.wheel(static_cast<int>(i));
  if (!left || !right) return;
  out.outputs.add(
      {out.prefix + "steering/ackermann_error", "rad",
       "angle of the outer wheel beyond the one for a common centre of turning"},
      [line, left = *left, right = *right] {
        return line->steering_error(left.state().steer, right.state().steer).value_or(0);
      });
}

// The half shafts' speeds are the spins of the wheels.
void add_shaft_channels(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  if (!built.has_drive || built.kinematic) return;
  // The line only answers which shafts there are; it is not the one that the engine steps.
  const std::unique_ptr<vehicle::DriveLine> line = vehicle::make_drive_line(built);
  // Motors in the wheels have no shafts; the efforts of the wheels' joints report them.
  if (!line->has_shafts()) return;
  add_engine(out);
  for (const vehicle::Coupled& one : line->differentials()) add_differential(out, one);
  for (std::size_t w = 0; w < built.wheels.size(); ++w)
    if (built.wheels[w].driven)
      out.outputs.add(
          {out.prefix + built.wheels[w].joint + "/shaft_torque", "N m",
           "torque of the half shaft in the last step"},
          [wheel = out.machine.wheel(static_cast<int>(w))] { return wheel.state().shaft_torque; });
}

}  // namespace navvy::sim
