// SPDX-License-Identifier: Apache-2.0
// The subcommands of `navvy`: each adds its options to the parser and leaves its work in `action`.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
// CLI11 takes seconds to compile: only sources include it.
class App;
}  // namespace CLI

namespace navvy::cli {

/// What the chosen subcommand does; returns the exit status.
using Action = std::function<int()>;

/// `command_line` goes into the run's folder, the program's name first.
void add_run(CLI::App& app, Action& action, std::vector<std::string> command_line);
/// Layers of a site as a file.
void add_map(CLI::App& app, Action& action);
/// Those that only tell: faults, devices, soils, channels.
void add_check(CLI::App& app, Action& action);
void add_devices(CLI::App& app, Action& action);
void add_soils(CLI::App& app, Action& action);
void add_machines(CLI::App& app, Action& action);
void add_scenes(CLI::App& app, Action& action);
void add_channels(CLI::App& app, Action& action);
/// Adds the command that prints the elements of scene files.
void add_schema(CLI::App& app, Action& action);
/// Virtual soil rigs, and rows of measured speed.
void add_lab(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);

}  // namespace navvy::cli
