// SPDX-License-Identifier: Apache-2.0
// `navvy machines [NAME]`, `navvy scenes`, `navvy soils [NAME]`: list shipped data.
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
#include "core/error.h"
#include "core/math.h"
#include "scene/machine_text.h"
#include "scene/soil_values.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"

namespace navvy::cli {
namespace {

/// Prints names and descriptions of files.
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

int scenes() { return list(scene_io::shipped_scenes(), "scenes"); }

/// Prints the shipped machines and how a scene uses one.
int machines() {
  const int code = list(scene_io::shipped_machines(), "machines");
  std::printf(
      "Put one into a scene by <include><uri>model://NAME</uri></include> "
      "(docs/getting_started.md).\n");
  return code;
}

/// Prints what a machine is made of.
int one_machine(const std::string& name) {
  const std::string file = scene_io::find_machine(name, "machines");
  std::printf("%s\n  %s\n  file: %s\n%s", name.c_str(), scene_io::description_of(file).c_str(),
              file.c_str(), scene::machine_text(scene_io::load_machine(file)).c_str());
  return kOk;
}

/// Prints a table of the shipped soils.
int soils() {
  std::printf("%-22s %9s %6s %7s %8s %8s %7s  %s\n", "soil", "bank t/m3", "swell", "phi deg",
              "c kPa", "c_r kPa", "E MPa", "source");
  // Units as commonly used for soil; files use SI units.
  for (const scene::Soil& soil : scene_io::shipped_soils())
    std::printf("%-22s %9.2f %6.2f %7.1f %8.2f %8.2f %7.2f  %s\n", soil.name.c_str(),
                soil.bank_density / 1000, soil.swell, degrees(soil.friction_angle),
                soil.cohesion / 1000, soil.residual_cohesion / 1000, soil.young_modulus / 1e6,
                soil.source.c_str());
  std::puts(
      "E where a soil gives none: 1 MPa, or 200 c where that is more; steps grow with its root.");
  return kOk;
}

/// Prints what each test would measure on the soil, and the plane-strain angle that the soil's
/// angle would stand for if that test had measured it.
void print_friction_tests(const scene::Soil& soil) {
  const bool given = soil.friction_test != scene::FrictionTest::kPlaneStrain;
  const double source = given ? soil.tested_friction_angle : soil.friction_angle;
  std::printf("  friction angle in each test [deg], given for %s; psi %g deg\n",
              scene::name_of(soil.friction_test), degrees(soil.dilatancy_angle));
  std::printf("    %-14s %10s   phi if it had measured %.4g\n", "test", "this soil",
              degrees(source));
  for (const auto& [name, test] : scene::kFrictionTests) {
    const double phi = scene::plane_strain_angle(test, source, soil.dilatancy_angle);
    const bool above = scene::check_friction(test, source, soil.dilatancy_angle).has_value();
    char text[32];
    std::snprintf(text, sizeof text, above ? "above %.0f" : "%.1f",
                  above ? scene::kMostFrictionDegrees : degrees(phi));
    std::printf("    %-14s %10.1f   %s\n", name,
                degrees(scene::angle_in_test(test, soil.friction_angle, soil.dilatancy_angle)),
                text);
  }
}

/// Prints every value of a soil under its name in scene files, ready to be copied into a scene.
int one_soil(const std::string& name) {
  scene::Soil soil = scene_io::shipped_soil(name, "soils");
  std::printf("%s\n  source: %s\n", soil.name.c_str(), soil.source.c_str());
  for (const scene::SoilValue& value : scene::soil_values(soil))
    std::printf("  %-26s %12.6g   (%g to %g)\n", value.name, value.written(), value.low,
                value.high);
  std::printf("  %-26s %g %g %g\n", "color", static_cast<double>(soil.color[0]),
              static_cast<double>(soil.color[1]), static_cast<double>(soil.color[2]));
  // A stiffer soil needs shorter steps, in proportion to the root of its modulus.
  std::printf("  young_modulus_pa is %s; %.2f times the steps of 1 MPa\n",
              soil.young_modulus == scene::default_stiffness(soil.cohesion)
                  ? "the default of its cohesion"
                  : "its own, not 200 x its cohesion",
              std::sqrt(soil.young_modulus / 1e6));
  print_friction_tests(soil);
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
  command->add_option("name", *name, "a shipped machine or a machine file: prints its parts");
  command->callback([name, &action] {
    action = [name] { return name->empty() ? machines() : one_machine(*name); };
  });
}

void add_scenes(CLI::App& app, Action& action) {
  app.add_subcommand("scenes", "list the shipped scenes, which `run` and `check` find by name")
      ->callback([&action] { action = scenes; });
}

}  // namespace navvy::cli
