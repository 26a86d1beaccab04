// SPDX-License-Identifier: Apache-2.0
#include "scene_io/drive_rules.h"

#include <algorithm>
#include <string>
#include <variant>

#include "scene/drive_kinds.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

namespace {

/// Checks that the values of a differential fit its kind. With both values 0, one of limited slip
/// would be an open one.
void check_differential(const Element* element, const scene::Differential& read, Faults& faults) {
  using Kind = scene::Differential::Kind;
  if (element == nullptr) return;
  const bool values = has(*element, "preload_nm") || has(*element, "bias");
  if (read.kind == Kind::kLimitedSlip && read.preload == 0 && read.bias == 0)
    faults.error(*element, "limited_slip", "slips without limit: preload_nm and bias are both 0",
                 "give one of them, or <kind>open</kind>");
  // A missing <kind> has been reported; the default kind must not be held against the other values.
  if (const Element* kind = element->FirstChildElement("kind");
      kind != nullptr && read.kind != Kind::kLimitedSlip && values)
    faults.error(*kind, text_of(*kind), "has neither preload_nm nor bias",
                 "remove them, or write limited_slip");
}

/// Checks the order of the points. Torque is interpolated over speed, so that two points at one
/// speed would divide by zero, and their order is that of the file.
void check_curve(Element& element, const scene::CombustionEngine& engine, Faults& faults) {
  const std::vector<Element*> points = children_of(element, {"point"});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Element& speed = child_or_self(*points[i], "speed_rpm");
    const Element& torque = child_or_self(*points[i], "torque_nm");
    if (i > 0 && engine.curve[i].speed <= engine.curve[i - 1].speed)
      faults.error(speed, text_of(speed), "the points of a torque curve must rise in speed",
                   "order them from idle to the governed speed");
    if (i == 0 && engine.curve[i].torque <= 0)
      faults.error(torque, text_of(torque), "an engine without torque at idle moves nothing",
                   "give a torque above 0 at the first point");
  }
}

/// Reports elements of one kind of engine in an engine of the other kind.
void check_engine_kind(const Element& element, const scene::CombustionEngine& engine,
                       Faults& faults) {
  const bool source = engine.kind == scene::CombustionEngine::Kind::kSpeedSource;
  // Which elements are needed depends on <kind>, so that marks of single fields cannot express it.
  for (const char* name : {"point", "braking_torque_nm", "shared_with_pump"})
    if (source && has(element, name))
      faults.error(element, name, "a speed_source has no such element",
                   "remove it, or <kind>torque_curve</kind>");
  for (const char* name : {"max_speed_rpm", "max_torque_nm"}) {
    if (!source && has(element, name))
      faults.error(element, name, "a torque_curve has no such element: its points give the value",
                   "remove it, or <kind>speed_source</kind>");
    if (source && !has(element, name))
      faults.error(element, "", std::string("a speed_source needs <") + name + ">");
  }
  if (source) return;
  if (!has(element, "braking_torque_nm"))
    faults.error(element, "", "a torque_curve needs <braking_torque_nm>",
                 "the torque that turns the engine without fuel; 0: it coasts");
  if (engine.curve.size() < 2)
    faults.error(element, std::to_string(engine.curve.size()) + " points",
                 "a torque curve needs two or more <point>s, from idle to the governed speed",
                 "e.g. <point><speed_rpm>800</speed_rpm><torque_nm>300</torque_nm></point>");
}

void check_gears(const Element& element, const std::vector<double>& gears, Faults& faults) {
  const Element& at = child_or_self(element, "gear_ratios");
  if (gears.empty())
    faults.error(at, text_of(at), "needs one gear or more",
                 "e.g. <gear_ratios>4 2 1</gear_ratios>");
  // `less_equal` also finds equal neighbours, which would be one gear written twice.
  if (std::adjacent_find(gears.begin(), gears.end(), std::less_equal<>()) != gears.end())
    faults.error(at, text_of(at), "the ratios must fall from the first gear to the last",
                 "order them by size");
}

/// Checks the engine of a drive and sets the power that it shares with the pump, if it does.
void finish_engine(Element& drive_element, scene::AckermannDrive& drive, Faults& faults) {
  Element* element = drive_element.FirstChildElement("engine");
  if (element == nullptr) return;
  // These describe the governed motor, which the engine replaces.
  for (const char* name : {"tractive_force_n", "power_w", "engine_power_w"})
    if (const Element* child = drive_element.FirstChildElement(name))
      faults.error(*child, text_of(*child), "follows from the drive's engine and gears",
                   "remove it, or <engine>");
  // Elements with faults of their own are not reported a second time.
  if (faults.has_fault(*element) || !drive.engine) return;
  scene::CombustionEngine& engine = *drive.engine;
  check_curve(*element, engine, faults);
  check_engine_kind(*element, engine, faults);
  check_gears(*element, engine.gears, faults);
  if (faults.has_fault(*element) || !engine.shared_with_pump) return;
  // The pump may take the maximum of speed times torque: the rated power of the curve.
  const scene::CombustionEngine::Point rated = scene::rated_point(engine);
  drive.engine_power = rated.speed * rated.torque;
}

void finish_kind(Element& element, scene::AckermannDrive& drive, Faults& faults) {
  check_differential(element.FirstChildElement("axle_differential"), drive.axles, faults);
  check_differential(element.FirstChildElement("centre_differential"), drive.centre, faults);
  finish_engine(element, drive, faults);
}

// The linkage steers an Ackermann drive, so the rules of both apply.
void finish_kind(Element& element, scene::LinkageDrive& drive, Faults& faults) {
  finish_kind(element, static_cast<scene::AckermannDrive&>(drive), faults);
  if (scene::turns_freely(drive)) return;
  // The arm is NaN where the tie rod cannot reach from arm to arm: the other of the two faults.
  const bool reaches = scene::steering_arm(drive).allFinite();
  faults.error(element, "tie_rod_m " + std::to_string(drive.tie_rod),
               reaches ? "the linkage locks before a wheel is at max_steer_deg"
                       : "the tie rod does not reach from arm to arm: it differs from track_m by "
                         "more than twice arm_m",
               "a tie rod nearer to track_m, a longer arm_m, a smaller max_steer_deg");
}

/// Does nothing: a kind of drive without an overload has no rules that concern several elements.
template <class Kind>
void finish_kind(Element&, Kind&, Faults&) {}
/// Does nothing: a kind of drive without an overload has no rules that concern the machine.
template <class Kind>
void check_kind(const Element&, const Kind&, const scene::Machine&, Faults&) {}

/// Skid steering turns a machine by the difference between its sides. The sides are those of the
/// links in the frame M of the machine, y to the left.
void check_kind(const Element& element, const scene::DifferentialDrive&,
                const scene::Machine& machine, Faults& faults) {
  bool left = false, right = false;
  for (const scene::Wheel& wheel : machine.wheels) {
    if (!wheel.steer_joint.empty())
      faults.error(element, wheel.steer_joint, "a differential drive steers no wheels",
                   "remove <steer_joint> from the wheel; a caster swivels by itself");
    const int joint = machine.joint_index(wheel.joint);
    // An unknown joint has been reported at its wheel.
    if (joint < 0 || !wheel.driven) continue;
    const int link = machine.joints[static_cast<std::size_t>(joint)].child;
    const double y = machine.links[static_cast<std::size_t>(link)].X_ML.translation().y();
    (y > 0 ? left : right) = true;
  }
  if (!left || !right)
    faults.error(element, "",
                 "a differential drive needs a driven wheel on the left and one on the right "
                 "(y > 0, y < 0)",
                 "set <driven>true</driven> in wheels of both sides");
}

/// The tie rod joins exactly two wheels; both ends have a king pin.
void check_kind(const Element& element, const scene::LinkageDrive&, const scene::Machine& machine,
                Faults& faults) {
  const auto steered =
      std::count_if(machine.wheels.begin(), machine.wheels.end(),
                    [](const scene::Wheel& wheel) { return !wheel.steer_joint.empty(); });
  if (steered != 2)
    faults.error(element, std::to_string(steered), "a steering linkage turns two wheels",
                 "give <steer_joint> to the two wheels at the ends of the tie rod");
}

/// Checks an engine that drives the pump, too: there is a pump, and the engine is strong enough.
void check_shared_power(const Element& element, const scene::Machine& machine, Faults& faults) {
  const double power = scene::powertrain(machine.drive).engine_power;
  if (power <= 0) return;
  if (!machine.has_pump)
    faults.error(element, std::to_string(power) + " W",
                 "the machine has no pump to share its engine's power with",
                 "add <navvy:pump>, or remove engine_power_w or shared_with_pump");
  else if (machine.pump.power > power)
    faults.error(
        element, std::to_string(power) + " W",
        "the pump alone takes up to " + std::to_string(machine.pump.power) + " W of its engine",
        "give the pump at most the power_w of the engine");
}

/// Checks the running gear of a track whose sprocket is at `p_sprocket` in the carrier: the link
/// that the sprocket's joint hangs on, in whose frame the points of a track are given.
void check_track(const Element& element, const scene::Wheel& wheel, const Vec3& p_sprocket,
                 Faults& faults) {
  const scene::Track& track = *wheel.track;
  const std::size_t n = track.rollers.size();
  const Element& rollers = child_or_self(element, "roller_m");
  const auto place = [&](const char* axis, double value) {
    return std::string("the sprocket is at ") + axis + " " + std::to_string(value) +
           " m of the link that carries the track";
  };
  // The rules below take a first and a last roller, which `lower_run` needs as well.
  if (n < 2) {
    faults.error(element, std::to_string(n), "a track needs two rollers or more",
                 "add <roller_m>x y z</roller_m>");
    return;
  }
  for (std::size_t i = 1; i < n; ++i) {
    // The rollers are sorted, so a difference below 1 mm, of either sign, is one place given twice.
    if (track.rollers[i - 1].x() - track.rollers[i].x() < 1e-3)
      faults.error(rollers, std::to_string(track.rollers[i].x()),
                   "two rollers of a track have the same x", "give each roller its own x");
    // The lower run is taken as straight from the first to the last roller.
    if (std::abs(track.rollers[i].z() - track.rollers[0].z()) > track.roller_radius)
      faults.error(rollers, std::to_string(track.rollers[i].z()),
                   "the rollers of a track must be within their radius of one height",
                   "change its z");
  }
  // Half the width of the track: a wheel further out would run beside it.
  const auto beside = [&](const Vec3& p) {
    return std::abs(p.y() - p_sprocket.y()) > 0.5 * wheel.width;
  };
  for (const Vec3& roller : track.rollers)
    if (beside(roller))
      faults.error(rollers, std::to_string(roller.y()) + " m",
                   "the roller is beside the track of its sprocket", place("y", p_sprocket.y()));
  if (beside(track.p_idler))
    faults.error(child_or_self(element, "idler_m"), std::to_string(track.p_idler.y()) + " m",
                 "the idler is beside the track of its sprocket", place("y", p_sprocket.y()));
  const double front = std::max(track.p_idler.x(), p_sprocket.x());
  const double rear = std::min(track.p_idler.x(), p_sprocket.x());
  const double first = track.rollers.front().x(), last = track.rollers.back().x();
  if (first >= front || last <= rear)
    faults.error(rollers, std::to_string(first) + " to " + std::to_string(last) + " m",
                 "the rollers must be between idler and sprocket", place("x", p_sprocket.x()));
  // 1e-6 m allows for rounding: idler and sprocket may touch the line of the lower run.
  const double run = track.lower_run()[0].z();
  const std::pair<const char*, double> ends[] = {
      {"idler_m", track.p_idler.z() - track.idler_radius - track.thickness},
      {"joint", p_sprocket.z() - wheel.radius - track.thickness}};
  for (const auto& [name, bottom] : ends)
    if (bottom < run - 1e-6)
      faults.error(child_or_self(element, name), std::to_string(bottom) + " m",
                   "the track would hang below its rollers, whose lower run is at z " +
                       std::to_string(run) + " m",
                   "raise it, or lower the rollers");
}

}  // namespace

void finish_drive(Element& element, scene::Drive& drive, Faults& faults) {
  std::visit([&](auto& kind) { finish_kind(element, kind, faults); }, drive);
}

void finish_tracks(Element& model, scene::Machine& machine, Faults& faults) {
  // Both kinds of elements fill one list of wheels, in the order of the file.
  const std::vector<Element*> elements = children_of(model, {"navvy:wheel", "navvy:track"});
  for (std::size_t i = 0; i < machine.wheels.size(); ++i) {
    scene::Wheel& wheel = machine.wheels[i];
    const Element& element = *elements.at(i);
    if (!wheel.track) continue;
    // A file may list the rollers in any order; all that use them expect front to rear.
    std::stable_sort(wheel.track->rollers.begin(), wheel.track->rollers.end(),
                     [](const Vec3& a, const Vec3& b) { return a.x() > b.x(); });
    const int joint = machine.joint_index(wheel.joint);
    if (joint < 0 || machine.links.empty()) continue;
    const Element& at_joint = child_or_self(element, "joint");
    const scene::Joint& spin = machine.joints[static_cast<std::size_t>(joint)];
    if (spin.type != scene::Joint::Type::kRevolute || spin.parent < 0) {
      faults.error(at_joint, wheel.joint, "a sprocket spins on a revolute joint of the machine",
                   "name the continuous joint between the track's frame and its sprocket");
      continue;
    }
    // C is the carrier. X_ML are the poses of the file, with all joints at zero.
    const Pose X_CM = machine.links[static_cast<std::size_t>(spin.parent)].X_ML.inverse();
    const Pose X_ML = machine.links[static_cast<std::size_t>(spin.child)].X_ML;
    const Vec3 axis = (X_CM * X_ML * spin.X_LcJ).linear() * spin.axis;
    // 0.999 allows 2.6 deg, more than angles in a file are rounded by, and refuses an axis that
    // points to the right, whose sprocket would drive backwards.
    if (axis.y() < 0.999)
      faults.error(at_joint, wheel.joint,
                   "a sprocket turns about y of the link that carries its track",
                   "write <xyz>0 1 0</xyz>, and turn that link so that x is ahead and z up");
    check_track(element, wheel, X_CM * (X_ML * Vec3(spin.X_LcJ.translation())), faults);
    if (machine.has_drive && scene::differential_drive(machine.drive) == nullptr)
      faults.error(element, scene::drive_name(machine.drive),
                   "tracks steer by the difference of their speeds",
                   "use <navvy:drive type=\"differential\">");
  }
}

void check_wheels(const Element& element, const scene::Machine& machine, Faults& faults) {
  std::visit([&](const auto& kind) { check_kind(element, kind, machine, faults); }, machine.drive);
  check_shared_power(element, machine, faults);
}

}  // namespace navvy::scene_io
