// SPDX-License-Identifier: Apache-2.0
#include "scene_io/drive_reader.h"

#include <algorithm>
#include <variant>

#include "scene_io/engine_reader.h"
#include "scene_io/fields.h"

namespace navvy::scene_io {

namespace {

Fields& read_powertrain(Fields& fields, scene::Powertrain& powertrain) {
  return fields.attribute("type")
      .number("max_speed_m_per_s", powertrain.max_speed, {0.01, 50})
      .number("tractive_force_n", powertrain.tractive_force, {0.1, 1e7})
      .number("power_w", powertrain.power, {0.1, 1e7})
      .number("brake_force_n", powertrain.brake_force, {0, 1e7})
      .number("engine_power_w", powertrain.engine_power, {0.1, 1e7});
}

void read_differential(Element& element, scene::Differential& out, Faults& faults) {
  using Kind = scene::Differential::Kind;
  Fields fields(element, faults);
  fields
      .choice<Kind>("kind", out.kind,
                    {{"open", Kind::kOpen}, {"locked", Kind::kLocked}, {"limited_slip", Kind::kLimitedSlip}})
      .required("kind")
      .number("preload_nm", out.preload, {0, 1e6})
      .number("bias", out.bias, {0, 1})
      .finish();
  if (out.kind == Kind::kLimitedSlip && out.preload == 0 && out.bias == 0)
    faults.error(element, "limited_slip", "slips without limit: preload_nm and bias are both 0",
                 "give one of them, or <kind>open</kind>");
  if (fields.has("kind") && out.kind != Kind::kLimitedSlip && (fields.has("preload_nm") || fields.has("bias")))
    faults.error(element, text_of(*element.FirstChildElement("kind")), "has neither preload_nm nor bias",
                 "remove them, or <kind>limited_slip</kind>");
}

Fields& read_steering(Fields& fields, scene::AckermannDrive& drive, Faults& faults) {
  read_powertrain(fields, drive)
      .number("max_steer_deg", drive.max_steer, {0, 80}, kDegree)
      .number("wheelbase_m", drive.wheelbase, {0.01, 50})
      .number("track_m", drive.track, {0.01, 50})
      .number("steer_rate_deg_per_s", drive.steer_rate, {0.1, 1000}, kDegree)
      .nested("axle_differential", [&](Element& e) { read_differential(e, drive.axles, faults); })
      .nested("centre_differential", [&](Element& e) { read_differential(e, drive.centre, faults); })
      .nested("engine", [&](Element& e) { read_engine(e, drive, faults); });
  for (const char* name : {"tractive_force_n", "power_w", "engine_power_w"})
    if (fields.has("engine") && fields.has(name))
      faults.error(*fields.child(name), text_of(*fields.child(name)), "is what the drive's engine and gears say",
                   "remove it, or <engine>");
  return fields;
}

void read_kind(Element& element, scene::AckermannDrive& drive, Faults& faults) {
  Fields fields(element, faults);
  read_steering(fields, drive, faults).finish();
}

void read_kind(Element& element, scene::LinkageDrive& drive, Faults& faults) {
  Fields fields(element, faults);
  read_steering(fields, drive, faults)
      .number("arm_m", drive.arm, {0.001, 5})
      .number("tie_rod_m", drive.tie_rod, {0.01, 50})
      .required("arm_m")
      .required("tie_rod_m")
      .flag("ahead", drive.ahead)
      .number("gear_ratio", drive.gear_ratio, {0.001, 1e4})
      .finish();
  if (scene::turns_freely(drive)) return;
  faults.error(element, "tie_rod_m " + std::to_string(drive.tie_rod),
               scene::steering_arm(drive).allFinite()
                   ? "the linkage locks before a wheel is at max_steer_deg"
                   : "the tie rod does not reach from arm to arm: it differs from track_m by more than twice arm_m",
               "a tie rod nearer to track_m, a longer arm_m, a smaller max_steer_deg");
}

void read_kind(Element& element, scene::DifferentialDrive& drive, Faults& faults) {
  Fields fields(element, faults);
  read_powertrain(fields, drive).number("track_m", drive.track, {0.01, 50}).required("track_m").finish();
}

// What each kind of drive asks of the wheels.
void check_kind(const Element& element, const scene::DifferentialDrive&, const scene::Machine& machine,
                Faults& faults) {
  bool left = false, right = false;
  for (const scene::Wheel& wheel : machine.wheels) {
    if (!wheel.steer_joint.empty())
      faults.error(element, wheel.steer_joint, "a differential drive turns no wheels",
                   "take <steer_joint> out of the wheel; a caster swivels by itself");
    const int joint = machine.joint_index(wheel.joint);
    if (joint < 0 || !wheel.driven) continue;
    const int link = machine.joints[static_cast<std::size_t>(joint)].child;
    (machine.links[static_cast<std::size_t>(link)].X_ML.translation().y() > 0 ? left : right) = true;
  }
  if (!left || !right)
    faults.error(element, "",
                 "a differential drive needs a driven wheel on the left and one on the right (y > 0, y < 0)",
                 "set <driven>true</driven> in wheels of both sides");
}
void check_kind(const Element&, const scene::AckermannDrive&, const scene::Machine&, Faults&) {}
void check_kind(const Element& element, const scene::LinkageDrive&, const scene::Machine& machine, Faults& faults) {
  const auto steered = std::count_if(machine.wheels.begin(), machine.wheels.end(),
                                     [](const scene::Wheel& wheel) { return !wheel.steer_joint.empty(); });
  if (steered != 2)
    faults.error(element, std::to_string(steered), "a steering linkage turns two wheels",
                 "give <steer_joint> to the two wheels between which the tie rod lies");
}

/// One engine for drive and pump needs both, and must at least drive the pump.
void check_shared_power(const Element& element, const scene::Machine& machine, Faults& faults) {
  const double power = scene::powertrain(machine.drive).engine_power;
  if (power <= 0) return;
  if (!machine.has_pump)
    faults.error(element, std::to_string(power) + " W", "the machine has no pump to share its engine's power with",
                 "add <navvy:pump>, or take engine_power_w or shared_with_pump out");
  else if (machine.pump.power > power)
    faults.error(element, std::to_string(power) + " W",
                 "the pump alone takes up to " + std::to_string(machine.pump.power) + " W of its engine",
                 "give the pump no more power_w than the engine has");
}

}  // namespace

scene::Wheel read_wheel(Element& element, const Names& names, Faults& faults) {
  scene::Wheel wheel;
  Fields(element, faults)
      .attribute("name")
      .text("joint", wheel.joint)
      .required("joint")
      .text("steer_joint", wheel.steer_joint)
      .flag("driven", wheel.driven)
      .number("radius_m", wheel.radius, {0.01, 5})
      .number("width_m", wheel.width, {0.005, 5})
      .number("twin_spacing_m", wheel.twin_spacing, {0, 5})
      .number("stiffness_n_per_m", wheel.stiffness, {100, 1e9})
      .number("damping_n_s_per_m", wheel.damping, {0, 1e8})
      .number("friction", wheel.friction, {0, 3})
      .number("rolling_resistance", wheel.rolling_resistance, {0, 1})
      .finish();
  require_name(element, "joint", "joint", names.joints, faults);
  require_name(element, "steer_joint", "joint", names.joints, faults);
  return wheel;
}

scene::Drive read_drive(Element& element, Faults& faults) {
  const std::string type = attribute(element, "type");
  // Every kind of the variant by its name, so that a new one is offered here as soon as it has a read_kind.
  const std::vector<scene::Drive> kinds = {scene::AckermannDrive(), scene::DifferentialDrive(), scene::LinkageDrive()};
  std::vector<std::string> names;
  for (scene::Drive drive : kinds) {
    names.push_back(scene::drive_name(drive));
    if (type != names.back() && !(type.empty() && names.size() == 1)) continue;
    std::visit([&](auto& kind) { read_kind(element, kind, faults); }, drive);
    return drive;
  }
  faults.error(element, type, "no drive of this type", faults.nearest(type, names));
  return {};
}

void check_wheels(const Element& element, const scene::Machine& machine, Faults& faults) {
  std::visit([&](const auto& kind) { check_kind(element, kind, machine, faults); }, machine.drive);
  check_shared_power(element, machine, faults);
}

}  // namespace navvy::scene_io
