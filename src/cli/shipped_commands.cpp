// SPDX-License-Identifier: Apache-2.0
// `navvy machines [NAME]`, `navvy scenes`, `navvy soils [NAME]`: what is shipped.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/math.h"
#include "scene/soil_values.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"

namespace navvy::cli {
namespace {

int list(const std::map<std::string, std::string>& files, const char* what) {
  if (files.empty())
    throw InputError(
        Fault{Fault::Severity::kError, "", 0, what, "", "none of the shipped ones were found",
              "set NAVVY_DATA_DIR to the directory that holds scenarios/, terrain/ and vehicles/"});
  std::size_t width = 0;
  for (const auto& [name, path] : files) width = std::max(width, name.size());
  for (const auto& [name, path] : files)
    std::printf("%-*s  %s\n", static_cast<int>(width), name.c_str(),
                scene_io::description_of(path).c_str());
  return kOk;
}

int scenes() { return list(shipped_scenes(), "scenes"); }

int machines() {
  const int code = list(scene_io::shipped_machines(), "machines");
  std::printf(
      "Put one into a scene by <include><uri>model://NAME</uri></include> "
      "(scenarios/README.md).\n");
  return code;
}

/// "revolute, boom to stick, -40.0 to 65.0 deg".
std::string told(const scene::Machine& machine, const scene::Joint& joint) {
  using Type = scene::Joint::Type;
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

void print_drive(const scene::Drive& drive) {
  const scene::Powertrain& common = scene::powertrain(drive);
  const scene::CombustionEngine* engine = scene::drive_engine(drive);
  if (engine == nullptr) {
    std::printf("  drive: %s, %.1f m/s, %.0f kN at the wheels, %.0f kW\n", scene::drive_name(drive),
                common.max_speed, common.tractive_force / 1000, common.power / 1000);
  } else {
    std::printf("  drive: %s, %.1f m/s\n", scene::drive_name(drive), common.max_speed);
    const scene::CombustionEngine::Point rated = scene::rated_point(*engine);
    if (engine->kind == scene::CombustionEngine::Kind::kSpeedSource)
      std::printf("  engine: speed source, %.3g N m, %.0f rpm at most; gears", engine->max_torque,
                  engine->max_speed * 30 / kPi);
    else
      std::printf("  engine: torque curve, %.1f kW at %.0f rpm; gears",
                  rated.torque * rated.speed / 1000, rated.speed * 30 / kPi);
    for (const double gear : engine->gears) std::printf(" %g", gear);
    std::printf(", final %g\n", engine->final_ratio);
  }
  if (common.engine_power > 0)
    std::printf("  drive and pump share an engine of %.0f kW\n", common.engine_power / 1000);
}

/// What it weighs, what moves, what it takes up and what drives it.
int one_machine(const std::string& name) {
  const std::map<std::string, std::string> files = scene_io::shipped_machines();
  const auto found = files.find(name);
  if (found == files.end()) {
    std::vector<std::string> names;
    names.reserve(files.size());
    for (const auto& [one, path] : files) names.push_back(one);
    throw InputError(Fault{Fault::Severity::kError, "", 0, "machines", name,
                           "no such shipped machine", suggestion(name, names)});
  }
  const scene::Machine machine = scene_io::load_machine(found->second);
  double mass = 0;
  for (const scene::Link& link : machine.links) mass += link.mass;
  std::printf("%s\n  %s\n  file: %s\n  mass: %.0f kg%s\n", name.c_str(),
              scene_io::description_of(found->second).c_str(), found->second.c_str(), mass,
              machine.kinematic    ? "; moved by its joints' positions, without dynamics"
              : machine.fixed_base ? "; its base is fixed"
                                   : "");
  std::printf("  links: %zu\n", machine.links.size());
  for (const scene::Link& link : machine.links)
    std::printf("    %-24s %9.1f kg\n", link.name.c_str(), link.mass);
  std::printf("  joints: %zu\n", machine.joints.size());
  for (const scene::Joint& joint : machine.joints)
    std::printf("    %-24s %s\n", joint.name.c_str(), told(machine, joint).c_str());
  for (const scene::Bucket& bucket : machine.buckets)
    std::printf("  bucket '%s': %.2f m3 heaped, cuts %.2f m\n", bucket.link.c_str(),
                bucket.capacity, bucket.width);
  for (const scene::Bed& bed : machine.beds)
    std::printf("  bed '%s': %.2f m3 struck, tipped by '%s'\n", bed.link.c_str(), bed.capacity,
                bed.joint.c_str());
  for (const scene::Cylinder& cylinder : machine.cylinders)
    std::printf("  cylinder '%s': moves '%s', %d x %.0f mm bore, %.1f MPa, %.0f l/min\n",
                cylinder.name.c_str(), cylinder.joint.c_str(), cylinder.count, 1000 * cylinder.bore,
                cylinder.pressure / 1e6, 60000 * cylinder.flow);
  if (machine.has_pump)
    std::printf("  pump: %.0f l/min, %.0f kW\n", 60000 * machine.pump.flow,
                machine.pump.power / 1000);
  const auto driven = std::count_if(machine.wheels.begin(), machine.wheels.end(),
                                    [](const scene::Wheel& wheel) { return wheel.driven; });
  if (!machine.wheels.empty())
    std::printf("  wheels: %zu, %d driven\n", machine.wheels.size(), static_cast<int>(driven));
  for (const scene::Encoder& encoder : machine.encoders)
    std::printf("  encoder on '%s': %.10g counts a turn, %d bits\n", encoder.joint.c_str(),
                encoder.counts_per_turn, encoder.bits);
  if (machine.levers.given)
    std::printf("  levers: %s, dead band %.0f %%\n",
                machine.levers.pattern == scene::Levers::Pattern::kIso ? "ISO" : "SAE",
                100 * machine.levers.dead_band);
  if (machine.has_drive) print_drive(machine.drive);
  return kOk;
}

int soils() {
  std::printf("%-22s %9s %6s %7s %8s %8s %7s  %s\n", "soil", "bank t/m3", "swell", "phi deg",
              "c kPa", "c_r kPa", "E MPa", "source");
  // In units that people use for soil; the files have SI with the unit in each name.
  for (const scene::Soil& soil : scene_io::shipped_soils())
    std::printf("%-22s %9.2f %6.2f %7.1f %8.2f %8.2f %7.2f  %s\n", soil.name.c_str(),
                soil.bank_density / 1000, soil.swell, degrees(soil.friction_angle),
                soil.cohesion / 1000, soil.residual_cohesion / 1000, soil.young_modulus / 1e6,
                soil.source.c_str());
  std::puts(
      "E where a soil gives none: 1 MPa, or 200 c where that is more; steps grow with its root.");
  return kOk;
}

/// Prints every value of a soil under its name in scene files, ready to be copied into a scene.
int one_soil(const std::string& name) {
  const scene::Soil soil = scene_io::shipped_soil(name, "soils");
  std::printf("%s\n  source: %s\n", soil.name.c_str(), soil.source.c_str());
  for (const scene::SoilValue& value : scene::soil_values())
    std::printf("  %-26s %12.6g   (%g to %g)\n", value.name, value.written(soil), value.low,
                value.high);
  std::printf("  %-26s %g %g %g\n", "color", static_cast<double>(soil.color[0]),
              static_cast<double>(soil.color[1]), static_cast<double>(soil.color[2]));
  std::printf("  young_modulus_pa is %s; %.2f times the steps of 1 MPa\n",
              soil.young_modulus == scene::default_stiffness(soil.cohesion)
                  ? "the default of its cohesion"
                  : "its own, not 200 x its cohesion",
              std::sqrt(soil.young_modulus / 1e6));
  if (const auto soft = scene::too_soft(soil)) std::printf("  %s\n", soft->text().c_str());
  return kOk;
}

}  // namespace

void add_soils(CLI::App& app, Action& action) {
  auto name = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("soils", "list the shipped soils; with a name every value of that soil");
  command->add_option("name", *name, "a shipped soil: prints its values with unit and range");
  command->callback(
      [name, &action] { action = [name] { return name->empty() ? soils() : one_soil(*name); }; });
}

void add_machines(CLI::App& app, Action& action) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "machines",
      "list the shipped machines; with a name its mass, links, joints, capacities and drive");
  command->add_option("name", *name, "a shipped machine: tells what it is made of");
  command->callback([name, &action] {
    action = [name] { return name->empty() ? machines() : one_machine(*name); };
  });
}

void add_scenes(CLI::App& app, Action& action) {
  app.add_subcommand("scenes", "list the shipped scenes, which `run` and `check` find by name")
      ->callback([&action] { action = scenes; });
}

}  // namespace navvy::cli
