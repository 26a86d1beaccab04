// SPDX-License-Identifier: Apache-2.0
#include "scene/parameters.h"

#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/hash.h"

namespace navvy::scene {
namespace {

/// Puts values under a path.
class Writer {
 public:
  explicit Writer(Parameters& out, std::string path = "") : out_(out), path_(std::move(path)) {}
  /// One step deeper: "soil", or "soil[loam]".
  Writer at(const std::string& name) const { return Writer(out_, path_ + name + "/"); }
  Writer at(const std::string& list, const std::string& name) const {
    return at(list + "[" + name + "]");
  }
  Writer at(const std::string& list, std::size_t number) const {
    return at(list, std::to_string(number));
  }

  void operator()(const char* name, const std::string& value) const { out_[path_ + name] = value; }
  void operator()(const char* name, const char* value) const { out_[path_ + name] = value; }
  void operator()(const char* name, bool value) const { out_[path_ + name] = value ? "yes" : "no"; }
  void operator()(const char* name, int value) const { out_[path_ + name] = std::to_string(value); }
  void operator()(const char* name, std::uint64_t value) const {
    out_[path_ + name] = std::to_string(value);
  }
  void operator()(const char* name, double value) const { out_[path_ + name] = text(value); }
  template <class T, int R, int C, int O>
  void operator()(const char* name, const Eigen::Matrix<T, R, C, O, R, C>& value) const {
    std::string all;
    for (Eigen::Index i = 0; i < value.size(); ++i)
      all += (i == 0 ? "" : " ") + text(value.data()[i]);
    out_[path_ + name] = all;
  }
  void operator()(const char* name, const Pose& value) const {
    (*this)((std::string(name) + "/place").c_str(), Vec3(value.translation()));
    (*this)((std::string(name) + "/turn").c_str(), Mat3(value.linear()));
  }

 private:
  // Every double has a text of its own, and -0 is 0: no run tells them apart.
  static std::string text(double value) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.17g", value + 0.0);
    return digits;
  }

  Parameters& out_;
  std::string path_;
};

// Every member of a struct is bound here: one that is added does not compile until somebody has
// decided on which side it belongs. Names in [[maybe_unused]] bindings that are not put are those
// that a run only shows.

void put(const Writer& w, const Soil& soil) {
  const auto& [name, source, bank_density, swell, friction_angle, static_friction_share, cohesion,
               residual_cohesion, loose_cohesion, remoulding_strain, loosening_strain,
               opening_strain, young_modulus, poisson, dilatancy_angle, fast_friction_angle,
               grain_diameter, inertial_number, compaction_pressure, compaction_strain,
               tool_friction_angle, adhesion, bekker_kc, bekker_kphi, bekker_n, janosi_k, color] =
      soil;
  w("bank_density", bank_density);
  w("swell", swell);
  w("friction_angle", friction_angle);
  w("static_friction_share", static_friction_share);
  w("cohesion", cohesion);
  w("residual_cohesion", residual_cohesion);
  w("loose_cohesion", loose_cohesion);
  w("remoulding_strain", remoulding_strain);
  w("loosening_strain", loosening_strain);
  w("opening_strain", opening_strain);
  w("young_modulus", young_modulus);
  w("poisson", poisson);
  w("dilatancy_angle", dilatancy_angle);
  w("fast_friction_angle", fast_friction_angle);
  w("grain_diameter", grain_diameter);
  w("inertial_number", inertial_number);
  w("compaction_pressure", compaction_pressure);
  w("compaction_strain", compaction_strain);
  w("tool_friction_angle", tool_friction_angle);
  w("adhesion", adhesion);
  w("bekker_kc", bekker_kc);
  w("bekker_kphi", bekker_kphi);
  w("bekker_n", bekker_n);
  w("janosi_k", janosi_k);
}

void put(const Writer& w, const SolverSettings& solver) {
  // The control rate acts through the base step alone, which the state holds: left out, so that a
  // plain run's snapshot can be gone on from under a controller.
  const auto& [cell, courant, max_step, control_rate, max_particles, active_zone, exchange] =
      solver;
  w("cell", cell);
  w("courant", courant);
  w("max_step", max_step);
  w("max_particles", max_particles);
  w("awake_zone", active_zone);
  w("exchange", exchange);
}

void put(const Writer& w, const GroundFeature& feature) {
  const auto& [kind, center, yaw, length, width, height, angle, seed] = feature;
  w("kind", static_cast<int>(kind));
  w("center", center);
  w("yaw", yaw);
  w("length", length);
  w("width", width);
  w("height", height);
  w("angle", angle);
  w("seed", seed);
}

void put(const Writer& w, const std::vector<GroundLayer>& layers) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const auto& [soil, thickness] = layers[i];
    w.at("layer", i)("soil", soil);
    w.at("layer", i)("thickness", thickness);
  }
}

void put(const Writer& w, const StartGround& ground) {
  const auto& [file, scale, has_at, at_is_local, at, size, origin, has_origin, surface, depth,
               has_rock, rock, steep, features, layers, patches, active] = ground;
  // A map counts by its heights, which the ground itself answers for.
  w("is_map", !file.empty());
  w("has_at", has_at);
  w("at_is_local", at_is_local);
  w("at", at);
  w("size", size);
  w("has_origin", has_origin);
  if (has_origin) w("origin", origin);
  w("surface", surface);
  if (has_rock) w("rock", rock);
  if (!has_rock) w("depth", depth);
  w("steep", static_cast<int>(steep));
  for (std::size_t i = 0; i < features.size(); ++i) put(w.at("feature", i), features[i]);
  put(w, layers);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto& [min, max, patch_layers] = patches[i];
    const Writer one = w.at("patch", i);
    one("min", min);
    one("max", max);
    put(one, patch_layers);
  }
  for (std::size_t i = 0; i < active.size(); ++i) {
    const auto& [min, max, bottom] = active[i];
    const Writer one = w.at("awake", i);
    one("min", min);
    one("max", max);
    one("bottom", bottom);
  }
}

void put(const Writer& w, const Geometry& geometry) {
  const auto& [kind, size, radius, length, mesh_file, scale] = geometry;
  w("kind", static_cast<int>(kind));
  w("size", size);
  w("radius", radius);
  w("length", length);
  // The folder says where a machine is installed, not what it is.
  w("mesh", std::filesystem::path(mesh_file).filename().string());
  w("scale", scale);
}

void put(const Writer& w, const Link& link) {
  const auto& [name, X_ML, mass, p_LCom, inertia, visuals, collisions, material] = link;
  w("pose", X_ML);
  w("mass", mass);
  w("centre_of_mass", p_LCom);
  w("inertia", inertia);
  if (!material.name.empty()) w("material", material.name);
  for (std::size_t i = 0; i < collisions.size(); ++i) {
    // Where a shape came from changes nothing.
    const auto& [collision_name, geometry, X_LC, friction, derived] = collisions[i];
    const Writer one = w.at("collision", i);
    put(one, geometry);
    one("pose", X_LC);
    one("friction", friction);
  }
}

void put(const Writer& w, const Materials& materials) {
  const auto& [ground, pairs] = materials;
  // A scene without a table is what it was before there were any.
  if (!ground.empty()) w("ground", ground);
  for (const MaterialPair& pair : pairs) {
    const auto& [names, static_friction, kinetic_friction, restitution, softness] = pair;
    const Writer one = w.at("pair", names[0] + " " + names[1]);
    one("static_friction", static_friction);
    one("kinetic_friction", kinetic_friction);
    one("restitution", restitution);
    one("softness", softness);
  }
}

void put(const Writer& w, const Joint& joint) {
  const auto& [name, type, parent, child, X_LcJ, axis, has_limits, lower, upper, effort, velocity,
               damping, friction, initial, brake, cone, twist] = joint;
  w("type", static_cast<int>(type));
  w("parent", parent);
  w("child", child);
  w("pose", X_LcJ);
  w("axis", axis);
  w("has_limits", has_limits);
  w("lower", lower);
  w("upper", upper);
  w("effort", effort);
  w("velocity", velocity);
  w("damping", damping);
  w("friction", friction);
  w("initial", initial);
  // A joint without a brake is what it was before there were any.
  if (brake > 0) w("brake", brake);
  w("cone", cone);
  w("twist", twist);
}

void put(const Writer& w, const Cylinder& cylinder) {
  const auto& [name, joint, base_link, rod_link, p_base, p_rod, has_linkage, p_rocker, rocker_rod,
               rocker_coupler, coupler, p_coupler, count, bore, rod, pressure, spacing, flow] =
      cylinder;
  w("joint", joint);
  w("base_link", base_link);
  w("rod_link", rod_link);
  w("base_pin", p_base);
  w("rod_pin", p_rod);
  w("has_linkage", has_linkage);
  w("rocker_pin", p_rocker);
  w("rocker_rod", rocker_rod);
  w("rocker_coupler", rocker_coupler);
  w("coupler", coupler);
  w("coupler_pin", p_coupler);
  w("count", count);
  w("bore", bore);
  w("rod", rod);
  w("pressure", pressure);
  w("flow", flow);
}

void put(const Writer& w, const Track& track) {
  const auto& [p_idler, idler_radius, rollers, roller_radius, thickness] = track;
  w("idler", p_idler);
  w("idler_radius", idler_radius);
  for (std::size_t i = 0; i < rollers.size(); ++i) w.at("roller", i)("place", rollers[i]);
  w("roller_radius", roller_radius);
  w("thickness", thickness);
}

void put(const Writer& w, const Wheel& wheel) {
  const auto& [joint, steer_joint, driven, radius, width, twin_spacing, stiffness, damping,
               friction, rolling_resistance, track] = wheel;
  w("steer_joint", steer_joint);
  w("driven", driven);
  w("radius", radius);
  w("width", width);
  w("twin_spacing", twin_spacing);
  w("stiffness", stiffness);
  w("damping", damping);
  w("friction", friction);
  w("rolling_resistance", rolling_resistance);
  if (track) put(w.at("track"), *track);
}

void put(const Writer& w, const CombustionEngine& engine) {
  const auto& [kind, curve, braking_torque, max_speed, max_torque, gears, final_ratio, efficiency] =
      engine;
  w("kind", static_cast<int>(kind));
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto& [speed, torque] = curve[i];
    w.at("point", i)("speed", speed);
    w.at("point", i)("torque", torque);
  }
  w("braking_torque", braking_torque);
  w("max_speed", max_speed);
  w("max_torque", max_torque);
  for (std::size_t i = 0; i < gears.size(); ++i) w.at("gear", i)("ratio", gears[i]);
  w("final_ratio", final_ratio);
  w("efficiency", efficiency);
}

// The kinds of drive and the shells have bases, which no binding takes apart: what is added there
// is added here.
void put(const Writer& w, const AckermannDrive& drive) {
  w("max_steer", drive.max_steer);
  w("wheelbase", drive.wheelbase);
  w("track", drive.track);
  w("steer_rate", drive.steer_rate);
  for (const auto& [name, differential] :
       {std::pair{"axles", drive.axles}, std::pair{"centre", drive.centre}}) {
    const auto& [kind, preload, bias] = differential;
    // An open one is what there was before there were others: it hashes as then.
    if (kind == Differential::Kind::kOpen) continue;
    const Writer part = w.at(name);
    part("kind", static_cast<int>(kind));
    part("preload", preload);
    part("bias", bias);
  }
  if (drive.engine) put(w.at("engine"), *drive.engine);
}
void put(const Writer& w, const DifferentialDrive& drive) { w("track", drive.track); }
void put(const Writer& w, const LinkageDrive& drive) {
  put(w, static_cast<const AckermannDrive&>(drive));
  w("arm", drive.arm);
  w("tie_rod", drive.tie_rod);
  w("ahead", drive.ahead);
  w("gear_ratio", drive.gear_ratio);
}

void put(const Writer& w, const Drive& drive) {
  w("type", drive_name(drive));
  const auto& [max_speed, tractive_force, power, brake_force, engine_power] = powertrain(drive);
  w("max_speed", max_speed);
  w("tractive_force", tractive_force);
  w("power", power);
  w("brake_force", brake_force);
  // A drive that shares no engine hashes as before there were any.
  if (engine_power > 0) w("engine_power", engine_power);
  std::visit([&w](const auto& kind) { put(w, kind); }, drive);
}

/// Thousands of vertices in one number.
void put(const Writer& w, const Shell& shell) {
  StateHash sum;
  for (const Vec3& vertex : shell.vertices) sum.bytes(vertex.data(), sizeof vertex);
  for (const auto& triangle : shell.triangles) sum.bytes(triangle.data(), sizeof triangle);
  w("triangles", sum.hex());
  w("link", shell.link);
  w("half_thickness", shell.half_thickness);
  w("friction_share", shell.friction_share);
  w("adhesion_share", shell.adhesion_share);
}

void put(const Writer& w, const Encoder& encoder) {
  const auto& [joint, counts_per_turn, bits, slip, missed] = encoder;
  w("counts_per_turn", counts_per_turn);
  w("bits", bits);
  w("slip", slip);
  w("missed", missed);
}

void put(const Writer& w, const Machine& machine) {
  const auto& [name, file, kinematic, fixed_base, links, joints, cylinders, has_pump, pump, wheels,
               has_drive, drive, shells, buckets, beds, arm, traversability, encoders, levers,
               derived] = machine;
  w("kinematic", kinematic);
  w("fixed_base", fixed_base);
  for (const Link& link : links) put(w.at("link", link.name), link);
  for (const Joint& joint : joints) put(w.at("joint", joint.name), joint);
  for (const Cylinder& cylinder : cylinders) put(w.at("cylinder", cylinder.name), cylinder);
  w("has_pump", has_pump);
  if (has_pump) {
    const auto& [flow, power] = pump;
    w("pump/flow", flow);
    w("pump/power", power);
  }
  for (const Wheel& wheel : wheels) put(w.at("wheel", wheel.joint), wheel);
  w("has_drive", has_drive);
  if (has_drive) put(w.at("drive"), drive);
  for (const Shell& shell : shells) put(w.at("shell", shell.name), shell);
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    const auto& [link, shell, capacity, width, p_tip, cut_direction, opening] = buckets[i];
    const Writer one = w.at("bucket", i);
    one("link", link);
    one("shell", shell);
    one("capacity", capacity);
    one("width", width);
    one("tip", p_tip);
    one("cut_direction", cut_direction);
    one("opening", opening);
  }
  for (std::size_t i = 0; i < beds.size(); ++i) {
    const auto& [link, shell, joint, capacity] = beds[i];
    const Writer one = w.at("bed", i);
    one("link", link);
    one("shell", shell);
    one("joint", joint);
    one("capacity", capacity);
  }
  const auto& [swing, boom, stick, bucket] = arm;
  w("arm", swing + " " + boom + " " + stick + " " + bucket);
  for (const Encoder& encoder : encoders) put(w.at("encoder", encoder.joint), encoder);
  const auto& [given, pattern, dead_band] = levers;
  // Usual levers do nothing that a machine without any could do otherwise: it hashes as before
  // there were any.
  if (given && pattern != Levers().pattern) w("levers/pattern", static_cast<int>(pattern));
  if (given && dead_band != Levers().dead_band) w("levers/dead_band", dead_band);
}

void put(const Writer& w, const MachineInWorld& placed) {
  [[maybe_unused]] const auto& [name, machine, X_WM, on_ground, load, program, line] = placed;
  put(w, machine);
  w("pose", X_WM);
  w("on_ground", on_ground);
  w("load/soil", load.mass > 0 ? load.soil : "");
  w("load/mass", load.mass);
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    const Writer one = w.at("program").at(program.steps[i]->element(), i);
    one("element", program.steps[i]->element());
    for (const auto& [child, text] : program.steps[i].values()) one(child.c_str(), text);
  }
}

void put(const Writer& w, const Hitch& hitch) {
  [[maybe_unused]] const auto& [name, parent, child, parent_link, child_link, hook, eye, cone,
                                twist, closed, line] = hitch;
  w("parent", parent);
  w("child", child);
  w("parent_link", parent_link);
  w("child_link", child_link);
  w("hook", hook);
  w("eye", eye);
  w("cone", cone);
  w("twist", twist);
  w("closed", closed);
}

}  // namespace

Parameters parameters(const Scene& scene) {
  Parameters out;
  const Writer w(out);
  const auto& [name, file, gravity, seed, solver, soils, ground, design, materials, machines,
               hitches, cameras, lights, recording, records] = scene;
  w("gravity", gravity);
  w("seed", seed);
  put(w.at("solver"), solver);
  // Layers of columns and bodies go by their numbers, so the order counts.
  for (std::size_t i = 0; i < soils.size(); ++i) {
    w.at("soil", soils[i].name)("number", static_cast<std::uint64_t>(i));
    put(w.at("soil", soils[i].name), soils[i]);
  }
  put(w.at("ground"), ground);
  put(w.at("materials"), materials);
  for (std::size_t i = 0; i < machines.size(); ++i) {
    w.at("machine", machines[i].name)("number", static_cast<std::uint64_t>(i));
    put(w.at("machine", machines[i].name), machines[i]);
  }
  // Channels and rows of the solver go by their numbers, too.
  for (std::size_t i = 0; i < hitches.size(); ++i) {
    w.at("hitch", hitches[i].name)("number", static_cast<std::uint64_t>(i));
    put(w.at("hitch", hitches[i].name), hitches[i]);
  }
  return out;
}

std::string differences(const Parameters& before, const Parameters& now, int most) {
  std::string out;
  int found = 0;
  const auto tell = [&](const std::string& path, const std::string& was, const std::string& is) {
    if (++found <= most) out += (out.empty() ? "" : "; ") + path + ": " + was + ", here " + is;
  };
  const auto quoted = [](const std::string& text) {
    return "'" + (text.size() <= 60 ? text : text.substr(0, 60) + "...") + "'";
  };
  for (const auto& [path, value] : before) {
    const auto other = now.find(path);
    if (other == now.end())
      tell(path, quoted(value), "nothing");
    else if (other->second != value)
      tell(path, quoted(value), quoted(other->second));
  }
  for (const auto& [path, value] : now)
    if (before.count(path) == 0) tell(path, "nothing", quoted(value));
  if (found > most) out += "; and " + std::to_string(found - most) + " more";
  return out;
}

}  // namespace navvy::scene
