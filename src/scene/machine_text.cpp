// SPDX-License-Identifier: Apache-2.0
#include "scene/machine_text.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "core/math.h"

namespace navvy::scene {
namespace {

/// Appends text that is formatted as by printf, at most 400 characters.
__attribute__((format(printf, 2, 3))) void add(std::string& out, const char* format, ...) {
  // Longer text is cut: a name alone may have 200 bytes (limits::kNameBytes).
  char text[400];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  out += text;
}

/// Returns a joint as text: "revolute, boom to stick, -40.0 to 65.0 deg".
std::string joint_text(const Machine& machine, const Joint& joint) {
  using Type = Joint::Type;
  const auto link = [&](int index) {
    return index < 0 ? std::string("world") : machine.links[static_cast<std::size_t>(index)].name;
  };
  std::string out = joint.type == Type::kFixed       ? "fixed"
                    : joint.type == Type::kRevolute  ? "revolute"
                    : joint.type == Type::kPrismatic ? "prismatic"
                                                     : "ball";
  out += ", " + link(joint.parent) + " to " + link(joint.child);
  if (joint.type != Type::kRevolute && joint.type != Type::kPrismatic) return out;
  if (!joint.has_limits) return out + ", without end";
  const bool turns = joint.type == Type::kRevolute;
  char limits[80];
  std::snprintf(limits, sizeof limits, turns ? ", %.1f to %.1f deg" : ", %.3f to %.3f m",
                turns ? degrees(joint.lower) : joint.lower,
                turns ? degrees(joint.upper) : joint.upper);
  return out + limits;
}

/// Adds the lines of a drive with its combustion engine.
void add_drive(std::string& out, const Drive& drive) {
  const Powertrain& common = powertrain(drive);
  const CombustionEngine* engine = drive_engine(drive);
  if (engine == nullptr) {
    add(out, "  drive: %s, %.1f m/s, %.0f kN at the wheels, %.0f kW\n", drive_name(drive),
        common.max_speed, common.tractive_force / 1000, common.power / 1000);
  } else {
    add(out, "  drive: %s, %.1f m/s\n", drive_name(drive), common.max_speed);
    const CombustionEngine::Point rated = rated_point(*engine);
    if (engine->kind == CombustionEngine::Kind::kSpeedSource)
      add(out, "  engine: speed source, %.3g N m, %.0f rpm at most; gears", engine->max_torque,
          // 30 / pi converts rad/s to rpm; 60000 below converts m3/s to l/min.
          engine->max_speed * 30 / kPi);
    else
      add(out, "  engine: torque curve, %.1f kW at %.0f rpm; gears",
          rated.torque * rated.speed / 1000, rated.speed * 30 / kPi);
    for (const double gear : engine->gears) add(out, " %g", gear);
    add(out, ", final %g\n", engine->final_ratio);
  }
  if (common.engine_power > 0)
    add(out, "  drive and pump share an engine of %.0f kW\n", common.engine_power / 1000);
}

}  // namespace

std::string machine_text(const Machine& machine) {
  std::string out;
  add(out, "  mass: %.0f kg%s\n", machine.total_mass(),
      machine.kinematic    ? "; moved by its joints' positions, without dynamics"
      : machine.fixed_base ? "; its base is fixed"
                           : "");
  add(out, "  links: %zu\n", machine.links.size());
  for (const Link& link : machine.links)
    add(out, "    %-24s %9.1f kg\n", link.name.c_str(), link.mass);
  add(out, "  joints: %zu\n", machine.joints.size());
  for (const Joint& joint : machine.joints)
    add(out, "    %-24s %s\n", joint.name.c_str(), joint_text(machine, joint).c_str());
  for (const Bucket& bucket : machine.buckets)
    add(out, "  bucket '%s': %.2f m3 heaped, cuts %.2f m\n", bucket.link.c_str(), bucket.capacity,
        bucket.width);
  for (const Bed& bed : machine.beds)
    add(out, "  bed '%s': %.2f m3 struck, tipped by '%s'\n", bed.link.c_str(), bed.capacity,
        bed.joint.c_str());
  for (const Cylinder& cylinder : machine.cylinders)
    add(out, "  cylinder '%s': moves '%s', %d x %.0f mm bore, %.1f MPa, %.0f l/min\n",
        cylinder.name.c_str(), cylinder.joint.c_str(), cylinder.count, 1000 * cylinder.bore,
        cylinder.pressure / 1e6, 60000 * cylinder.flow);
  if (machine.has_pump)
    add(out, "  pump: %.0f l/min, %.0f kW\n", 60000 * machine.pump.flow, machine.pump.power / 1000);
  const auto driven = std::count_if(machine.wheels.begin(), machine.wheels.end(),
                                    [](const Wheel& wheel) { return wheel.driven; });
  if (!machine.wheels.empty())
    add(out, "  wheels: %zu, %d driven\n", machine.wheels.size(), static_cast<int>(driven));
  for (const Encoder& encoder : machine.encoders)
    add(out, "  encoder on '%s': %.10g counts a turn, %d bits\n", encoder.joint.c_str(),
        encoder.counts_per_turn, encoder.bits);
  if (machine.levers.given)
    add(out, "  levers: %s, dead band %.0f %%\n",
        machine.levers.pattern == Levers::Pattern::kIso ? "ISO" : "SAE",
        100 * machine.levers.dead_band);
  if (machine.has_drive) add_drive(out, machine.drive);
  return out;
}

}  // namespace navvy::scene
