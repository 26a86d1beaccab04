// SPDX-License-Identifier: Apache-2.0
// `navvy check`, `devices`, `channels`: commands that only report.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "cli/severity.h"
#include "control/step_kinds.h"
#include "core/log.h"
#include "core/printable.h"
#include "device/device.h"
#include "run/scene_check.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"
#include "sim/world.h"
#include "sim/world_channels.h"

namespace navvy::cli {
namespace {

/// Prints values that follow from a machine's file.
void print_derived(const std::string& name, const scene::Machine& machine) {
  for (const std::string& one : machine.derived)
    std::printf("'%s': %s\n", name.c_str(), printable(one).c_str());
}

/// Prints all faults of all files, and what a first second of each scene shows.
int check(const std::vector<std::string>& files, const scene_io::Overrides& overrides) {
  std::size_t errors = 0, warnings = 0;
  // Warnings that libraries log during the check are printed once and counted.
  std::set<std::string> logged;
  set_log_sink([&](LogLevel level, const std::string& text) {
    if (level < LogLevel::kWarning || !logged.insert(text).second) return;
    std::cout << (has_severity(text) ? "" : "warning: ") << text << "\n";
    ++warnings;
  });
  for (const std::string& name : files) {
    // An unknown name is a fault of one file and does not keep the others from being checked.
    std::string file;
    try {
      file = scene_io::find_scene(name);
    } catch (const InputError& fault) {
      std::cout << fault.what() << "\n";
      ++errors;
      continue;
    }
    // All files are checked, so that a user can correct all faults at once.
    std::optional<scene::Scene> world;
    // A machine alone stands in a scene of its own; files of soils give no scene.
    std::optional<scene::Machine> machine;
    scene_io::FaultCount count;
    std::vector<Fault> faults =
        scene_io::check(file, control::step_kinds(), &world, overrides, &machine, &count);
    errors += count.errors;
    warnings += count.warnings;
    const std::size_t counted = faults.size();
    if (world)
      for (const scene::MachineInWorld& placed : world->machines)
        print_derived(placed.name, placed.machine);
    // Checks that need the machines on their ground.
    if (world) {
      run::SceneCheck start = run::check_scene(*world);
      for (const std::string& note : start.notes) std::cout << printable(note) << "\n";
      // That a trailer tips over by itself is no error of its file.
      for (Fault& fault : start.faults)
        if (machine && fault.element.rfind("include[", 0) == 0)
          fault.severity = Fault::Severity::kWarning;
      std::move(start.faults.begin(), start.faults.end(), std::back_inserter(faults));
    }
    for (std::size_t i = 0; i < faults.size(); ++i) {
      // Faults go to standard output, as they are the result.
      std::cout << faults[i].text() << "\n";
      if (i >= counted) ++(faults[i].severity == Fault::Severity::kError ? errors : warnings);
    }
  }
  set_log_sink({});
  // The last line is for people, the exit status for scripts.
  std::printf("%zu file%s checked: %zu error%s, %zu warning%s\n", files.size(),
              files.size() == 1 ? "" : "s", errors, errors == 1 ? "" : "s", warnings,
              warnings == 1 ? "" : "s");
  return errors > 0 ? kBadInput : kOk;
}

/// Prints a line for each OpenCL device.
int devices() {
  const auto list = device::list_devices();
  for (const auto& info : list) std::cout << info.text() << "\n";
  if (!list.empty()) return kOk;
  // Without any device the construction throws, with a message that says what to install.
  device::Device none;
  return kDevice;
}

/// Prints names, units and meanings of all inputs, outputs and arrays of a scene.
int channels(const SceneOptions& options) {
  device::Device device(options.device);
  // Channels depend on the machines, so the world is built but not run.
  const sim::World world(options.load(), device);
  std::fputs(sim::channel_list(world).c_str(), stdout);
  return kOk;
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  // The action keeps the options alive after parsing.
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("check",
                                         "validate scene, machine or soil files without running "
                                         "them: also the reach of digs, the view of\n"
                                         "sensors, and whether machines overlap or tip over in "
                                         "their first second");
  command->add_option("files", *files, "SDF files, or names of shipped scenes")->required();
  auto values = std::make_shared<SceneOptions>();
  values->add_values_to(*command);
  command->callback([files, values, &action] {
    action = [files, values] { return check(*files, values->overrides()); };
  });
}

void add_devices(CLI::App& app, Action& action) {
  app.add_subcommand("devices", "list OpenCL devices")->callback([&action] { action = devices; });
}

void add_channels(CLI::App& app, Action& action) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* command = app.add_subcommand(
      "channels", "list the named inputs and outputs of a scene (--control stdio)");
  // Takes the options of a run, as overrides may add or rename machines.
  options->add_to(*command);
  command->callback([options, &action] { action = [options] { return channels(*options); }; });
}

}  // namespace navvy::cli
