// SPDX-License-Identifier: Apache-2.0
// `navvy check`, `devices`, `soils`, `channels`: commands that only tell.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "control/step_kinds.h"
#include "core/math.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "session/program_check.h"
#include "sim/world.h"
#include "sim/world_channels.h"

namespace navvy::cli {
namespace {

int check(const std::vector<std::string>& files, const scene_io::Overrides& overrides) {
  int errors = 0, warnings = 0;
  for (const std::string& file : files) {
    // One pass over all files: a user fixes every fault in one go.
    std::optional<scene::Scene> world;
    // Machine and soil files are checked by themselves and give no world.
    std::vector<Fault> faults = scene_io::check(file, control::step_kinds(), &world, overrides);
    // What only a machine on its ground can tell: the test that a run makes before it starts.
    if (world)
      for (Fault& fault : session::check_programs(*world)) faults.push_back(std::move(fault));
    for (const Fault& fault : faults) {
      // On standard output: it is what was asked for.
      std::cout << fault.text() << "\n";
      ++(fault.severity == Fault::Severity::kError ? errors : warnings);
    }
  }
  // The last line is for people, the exit status for scripts.
  std::printf("%zu file%s checked: %d error%s, %d warning%s\n", files.size(), files.size() == 1 ? "" : "s", errors,
              errors == 1 ? "" : "s", warnings, warnings == 1 ? "" : "s");
  return errors > 0 ? kBadInput : kOk;
}

int devices() {
  // On standard output, for scripts.
  const auto list = device::list_devices();
  for (const auto& info : list) std::cout << info.text() << "\n";
  // None at all is a failure, with a message that helps.
  if (!list.empty()) return kOk;
  // Picking from an empty list says what to install.
  device::Device none;
  return kDevice;
}

int soils() {
  // The first data directory that has them, as a scene would find them.
  const std::string directory = scene_io::find_data("terrain/soils");
  if (directory.empty())
    throw InputError(Fault{Fault::Severity::kError, "terrain/soils", 0, "", "", "the shipped soils were not found",
                           "set NAVVY_DATA_DIR to the directory that holds terrain/ and vehicles/"});
  std::printf("%-22s %9s %6s %7s %8s %8s %7s  %s\n", "soil", "bank t/m3", "swell", "phi deg", "c kPa", "c_r kPa",
              "E MPa", "source");
  // In units that people use for soil; the files have SI with the unit in each name.
  for (const scene::Soil& soil : scene_io::load_soils(directory))
    std::printf("%-22s %9.2f %6.2f %7.1f %8.2f %8.2f %7.2f  %s\n", soil.name.c_str(), soil.bank_density / 1000,
                soil.swell, degrees(soil.friction_angle), soil.cohesion / 1000, soil.residual_cohesion / 1000,
                soil.young_modulus / 1e6, soil.source.c_str());
  return kOk;
}

int channels(const SceneOptions& options) {
  device::Device device(options.device);
  // The channels of a scene are those of its machines: it has to be built, but not run.
  const sim::World world(options.load(), device);
  std::fputs(sim::channel_list(world).c_str(), stdout);
  return kOk;
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  // Options outlive the parse in a shared pointer that the action keeps.
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("check", "validate scene, machine or soil files, the reach of digs too, without running them");
  command->add_option("files", *files, "SDF files")->required();
  auto values = std::make_shared<SceneOptions>();
  values->add_values_to(*command);
  command->callback(
      [files, values, &action] { action = [files, values] { return check(*files, values->overrides()); }; });
}

void add_devices(CLI::App& app, Action& action) {
  app.add_subcommand("devices", "list OpenCL devices")->callback([&action] { action = devices; });
}

void add_soils(CLI::App& app, Action& action) {
  app.add_subcommand("soils", "list the shipped soils")->callback([&action] { action = soils; });
}

void add_channels(CLI::App& app, Action& action) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* command = app.add_subcommand("channels", "list the named inputs and outputs of a scene (--control stdio)");
  // The same options as a run: overrides may add or rename machines.
  options->add_to(*command);
  command->callback([options, &action] { action = [options] { return channels(*options); }; });
}

}  // namespace navvy::cli
