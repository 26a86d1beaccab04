// SPDX-License-Identifier: Apache-2.0
// `navvy check`, `devices`, `channels`: commands that only tell.
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
#include "device/device.h"
#include "run/scene_check.h"
#include "scene_io/loader.h"
#include "sim/world.h"
#include "sim/world_channels.h"

namespace navvy::cli {
namespace {

/// Says what follows from a machine's file without standing in it.
void print_derived(const std::string& name, const scene::Machine& machine) {
  for (const std::string& one : machine.derived)
    std::printf("'%s': %s\n", name.c_str(), one.c_str());
}

int check(const std::vector<std::string>& files, const scene_io::Overrides& overrides) {
  std::size_t errors = 0, warnings = 0;
  // What libraries warn of while they try a start counts like any other: once, and on standard
  // output.
  std::set<std::string> told;
  set_log_sink([&](LogLevel level, const std::string& text) {
    if (level < LogLevel::kWarning || !told.insert(text).second) return;
    std::cout << (print_its_severity(text) ? "" : "warning: ") << text << "\n";
    ++warnings;
  });
  for (const std::string& name : files) {
    std::string file;
    try {
      file = find_scene(name);
    } catch (const InputError& fault) {
      std::cout << fault.what() << "\n";
      ++errors;
      continue;
    }
    // One pass over all files: a user fixes every fault in one go.
    std::optional<scene::Scene> world;
    // Machine and soil files are checked by themselves and give no world.
    std::optional<scene::Machine> machine;
    scene_io::FaultCount count;
    std::vector<Fault> faults =
        scene_io::check(file, control::step_kinds(), &world, overrides, &machine, &count);
    errors += count.errors;
    warnings += count.warnings;
    const std::size_t counted = faults.size();
    if (machine) print_derived(machine->name, *machine);
    if (world)
      for (const scene::MachineInWorld& placed : world->machines)
        print_derived(placed.name, placed.machine);
    if (world) {
      run::SceneCheck start = run::check_scene(*world);
      for (const std::string& note : start.notes) std::cout << note << "\n";
      std::move(start.faults.begin(), start.faults.end(), std::back_inserter(faults));
    }
    for (std::size_t i = 0; i < faults.size(); ++i) {
      // On standard output: it is what was asked for.
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
  CLI::App* command = app.add_subcommand("check",
                                         "validate scene, machine or soil files without running "
                                         "them: also the reach of digs, and whether\n"
                                         "machines overlap or tip over in their first second");
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
  // The same options as a run: overrides may add or rename machines.
  options->add_to(*command);
  command->callback([options, &action] { action = [options] { return channels(*options); }; });
}

}  // namespace navvy::cli
