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
      .choice<Kind>(
          "kind", out.kind,
          {{"open", Kind::kOpen}, {"locked", Kind::kLocked}, {"limited_slip", Kind::kLimitedSlip}})
      .required("kind")
      .number("preload_nm", out.preload, {0, 1e6})
      .number("bias", out.bias, {0, 1})
      .finish();
  if (out.kind == Kind::kLimitedSlip && out.preload == 0 && out.bias == 0)
    faults.error(element, "limited_slip", "slips without limit: preload_nm and bias are both 0",
                 "give one of them, or <kind>open</kind>");
  if (fields.has("kind") && out.kind != Kind::kLimitedSlip &&
      (fields.has("preload_nm") || fields.has("bias")))
    faults.error(element, text_of(*element.FirstChildElement("kind")),
                 "has neither preload_nm nor bias", "remove them, or <kind>limited_slip</kind>");
}

Fields& read_steering(Fields& fields, scene::AckermannDrive& drive, Faults& faults) {
  read_powertrain(fields, drive)
      .number("max_steer_deg", drive.max_steer, {0, 80}, kDegree)
      .number("wheelbase_m", drive.wheelbase, {0.01, 50})
      .number("track_m", drive.track, {0.01, 50})
      .number("steer_rate_deg_per_s", drive.steer_rate, {0.1, 1000}, kDegree)
      .nested("axle_differential", [&](Element& e) { read_differential(e, drive.axles, faults); })
      .nested("centre_differential",
              [&](Element& e) { read_differential(e, drive.centre, faults); })
      .nested("engine", [&](Element& e) { read_engine(e, drive, faults); });
  for (const char* name : {"tractive_force_n", "power_w", "engine_power_w"})
    if (fields.has("engine") && fields.has(name))
      faults.error(*fields.child(name), text_of(*fields.child(name)),
                   "is what the drive's engine and gears say", "remove it, or <engine>");
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
                   : "the tie rod does not reach from arm to arm: it differs from track_m by more "
                     "than twice arm_m",
               "a tie rod nearer to track_m, a longer arm_m, a smaller max_steer_deg");
}

void read_kind(Element& element, scene::DifferentialDrive& drive, Faults& faults) {
  Fields fields(element, faults);
  read_powertrain(fields, drive)
      .number("track_m", drive.track, {0.01, 50})
      .required("track_m")
      .finish();
}

// What each kind of drive asks of the wheels.
void check_kind(const Element& element, const scene::DifferentialDrive&,
                const scene::Machine& machine, Faults& faults) {
  bool left = false, right = false;
  for (const scene::Wheel& wheel : machine.wheels) {
    if (!wheel.steer_joint.empty())
      faults.error(element, wheel.steer_joint, "a differential drive turns no wheels",
                   "take <steer_joint> out of the wheel; a caster swivels by itself");
    const int joint = machine.joint_index(wheel.joint);
    if (joint < 0 || !wheel.driven) continue;
    const int link = machine.joints[static_cast<std::size_t>(joint)].child;
    (machine.links[static_cast<std::size_t>(link)].X_ML.translation().y() > 0 ? left : right) =
        true;
  }
  if (!left || !right)
    faults.error(
        element, "",
        "a differential drive needs a driven wheel on the left and one on the right (y > 0, y < 0)",
        "set <driven>true</driven> in wheels of both sides");
}
void check_kind(const Element&, const scene::AckermannDrive&, const scene::Machine&, Faults&) {}
void check_kind(const Element& element, const scene::LinkageDrive&, const scene::Machine& machine,
                Faults& faults) {
  const auto steered =
      std::count_if(machine.wheels.begin(), machine.wheels.end(),
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
    faults.error(element, std::to_string(power) + " W",
                 "the machine has no pump to share its engine's power with",
                 "add <navvy:pump>, or take engine_power_w or shared_with_pump out");
  else if (machine.pump.power > power)
    faults.error(
        element, std::to_string(power) + " W",
        "the pump alone takes up to " + std::to_string(machine.pump.power) + " W of its engine",
        "give the pump no more power_w than the engine has");
}

/// How a tyre or a belt meets the ground.
Fields& contact(Fields& fields, scene::Wheel& wheel) {
  return fields.number("width_m", wheel.width, {0.005, 5})
      .number("stiffness_n_per_m", wheel.stiffness, {100, 1e9})
      .number("damping_n_s_per_m", wheel.damping, {0, 1e8})
      .number("friction", wheel.friction, {0, 3})
      .number("rolling_resistance", wheel.rolling_resistance, {0, 1});
}

}  // namespace

scene::Wheel read_wheel(Element& element, const Names& names, Faults& faults) {
  scene::Wheel wheel;
  Fields fields(element, faults);
  fields.attribute("name")
      .text("joint", wheel.joint)
      .required("joint")
      .text("steer_joint", wheel.steer_joint)
      .flag("driven", wheel.driven)
      .number("radius_m", wheel.radius, {0.01, 5})
      .number("twin_spacing_m", wheel.twin_spacing, {0, 5});
  contact(fields, wheel).finish();
  require_name(element, "joint", "joint", names.joints, faults);
  require_name(element, "steer_joint", "joint", names.joints, faults);
  return wheel;
}

scene::Wheel read_track(Element& element, const Names& names, Faults& faults) {
  scene::Wheel wheel;
  scene::Track track;
  wheel.driven = true;
  // Of the class of 18 t (U); a robot's file says its own.
  wheel.width = 0.6;
  wheel.stiffness = 1.2e7;
  wheel.damping = 1.2e5;
  wheel.radius = 0.35;
  Fields fields(element, faults);
  fields.attribute("name")
      .text("joint", wheel.joint)
      .required("joint")
      .number("sprocket_radius_m", wheel.radius, {0.01, 5})
      .required("sprocket_radius_m")
      .vec3("idler_m", track.p_idler)
      .required("idler_m")
      .number("idler_radius_m", track.idler_radius, {0.01, 5})
      .required("idler_radius_m")
      .each("roller_m",
            [&](Element& e) {
              std::vector<double> p;
              if (read_numbers(e, 3, {-1e3, 1e3}, p, faults))
                track.rollers.emplace_back(p[0], p[1], p[2]);
            })
      .required("roller_m")
      .number("roller_radius_m", track.roller_radius, {0.005, 5})
      .required("roller_radius_m")
      .number("thickness_m", track.thickness, {0, 1});
  contact(fields, wheel).finish();
  require_name(element, "joint", "joint", names.joints, faults);
  std::stable_sort(track.rollers.begin(), track.rollers.end(),
                   [](const Vec3& a, const Vec3& b) { return a.x() > b.x(); });
  wheel.track = std::move(track);
  return wheel;
}

namespace {

/// Its running gear, once its sprocket is known to be at `p_sprocket` in the carrier.
void check_track(Element& element, const scene::Wheel& wheel, const Vec3& p_sprocket,
                 Faults& faults) {
  const scene::Track& track = *wheel.track;
  const std::size_t n = track.rollers.size();
  if (n < 2) {
    faults.error(element, std::to_string(n), "a belt stands on two rollers at least",
                 "add <roller_m>x y z</roller_m>");
    return;
  }
  Element* rollers = element.FirstChildElement("roller_m");
  for (std::size_t i = 1; i < n; ++i) {
    if (track.rollers[i - 1].x() - track.rollers[i].x() < 1e-3)
      faults.error(*rollers, std::to_string(track.rollers[i].x()),
                   "two rollers of a belt stand at the same x",
                   "give each a place of its own along the belt");
    if (std::abs(track.rollers[i].z() - track.rollers[0].z()) > track.roller_radius)
      faults.error(*rollers, std::to_string(track.rollers[i].z()),
                   "the rollers of a belt stand in a row, within their radius of one height",
                   "change its z");
  }
  const auto aside = [&](const Vec3& p) {
    return std::abs(p.y() - p_sprocket.y()) > 0.5 * wheel.width;
  };
  for (const Vec3& roller : track.rollers)
    if (aside(roller))
      faults.error(*rollers, std::to_string(roller.y()) + " m",
                   "a roller lies beside the belt of its sprocket",
                   "the sprocket stands at y " + std::to_string(p_sprocket.y()) +
                       " m of the link that carries the belt");
  if (aside(track.p_idler))
    faults.error(*element.FirstChildElement("idler_m"), std::to_string(track.p_idler.y()) + " m",
                 "the idler lies beside the belt of its sprocket",
                 "the sprocket stands at y " + std::to_string(p_sprocket.y()) +
                     " m of the link that carries the belt");
  const double front = std::max(track.p_idler.x(), p_sprocket.x()),
               rear = std::min(track.p_idler.x(), p_sprocket.x());
  if (track.rollers.front().x() >= front || track.rollers.back().x() <= rear)
    faults.error(*rollers,
                 std::to_string(track.rollers.front().x()) + " to " +
                     std::to_string(track.rollers.back().x()) + " m",
                 "the rollers must lie between idler and sprocket",
                 "the sprocket stands at x " + std::to_string(p_sprocket.x()) +
                     " m of the link that carries the belt");
  const double run = track.lower_run()[0].z();
  const struct {
    const char* name;
    double bottom;
  } ends[] = {{"idler_m", track.p_idler.z() - track.idler_radius - track.thickness},
              {"joint", p_sprocket.z() - wheel.radius - track.thickness}};
  for (const auto& end : ends)
    if (end.bottom < run - 1e-6)
      faults.error(*element.FirstChildElement(end.name), std::to_string(end.bottom) + " m",
                   "the belt would hang below its rollers, whose lower run is at z " +
                       std::to_string(run) + " m",
                   "raise it, or lower the rollers");
}

}  // namespace

void check_tracks(Element& model, const scene::Machine& machine, Faults& faults) {
  for (Element* e = model.FirstChildElement("navvy:track"); e;
       e = e->NextSiblingElement("navvy:track")) {
    const std::string name = child_text(*e, "joint");
    const int joint = machine.joint_index(name);
    const auto wheel = std::find_if(
        machine.wheels.begin(), machine.wheels.end(),
        [&](const scene::Wheel& one) { return one.track.has_value() && one.joint == name; });
    if (joint < 0 || wheel == machine.wheels.end()) continue;
    const scene::Joint& spin = machine.joints[static_cast<std::size_t>(joint)];
    if (spin.type != scene::Joint::Type::kRevolute || spin.parent < 0) {
      faults.error(*e->FirstChildElement("joint"), name,
                   "a sprocket spins on a revolute joint of the machine",
                   "name the continuous joint between the track's frame and its sprocket");
      continue;
    }
    const Pose X_MC = machine.links[static_cast<std::size_t>(spin.parent)].X_ML;
    const Pose X_ML = machine.links[static_cast<std::size_t>(spin.child)].X_ML;
    const Vec3 axis = (X_MC.inverse() * X_ML * spin.X_LcJ).linear() * spin.axis;
    if (axis.y() < 0.999)
      faults.error(*e->FirstChildElement("joint"), name,
                   "a sprocket turns about y of the link that carries its belt",
                   "write <xyz>0 1 0</xyz>, and turn that link so that x is ahead and z up");
    check_track(*e, *wheel, X_MC.inverse() * (X_ML * Vec3(spin.X_LcJ.translation())), faults);
    if (machine.has_drive && !std::holds_alternative<scene::DifferentialDrive>(machine.drive))
      faults.error(*e, scene::drive_name(machine.drive),
                   "tracks steer by the difference of their speeds",
                   "use <navvy:drive type=\"differential\">");
  }
}

scene::Drive read_drive(Element& element, Faults& faults) {
  const std::string type = attribute(element, "type");
  // Every kind of the variant by its name, so that a new one is offered here as soon as it has a
  // read_kind.
  const std::vector<scene::Drive> kinds = {scene::AckermannDrive(), scene::DifferentialDrive(),
                                           scene::LinkageDrive()};
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
