// SPDX-License-Identifier: Apache-2.0
// The subcommands of `navvy`: each function adds options to the parser. The chosen command stores
// its work in `action`.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
// CLI11 takes seconds to compile, so only sources include it.
class App;
}  // namespace CLI

namespace navvy::cli {

/// Runs the chosen subcommand; returns the exit status.
using Action = std::function<int()>;

/// Adds `navvy run`. `command_line` is recorded in the folder of the run, the program first.
void add_run(CLI::App& app, Action& action, std::vector<std::string> command_line);
/// Adds `navvy map`, which writes layers of a site to a file.
void add_map(CLI::App& app, Action& action);
/// Add commands that only report: faults, devices, shipped data, channels.
void add_check(CLI::App& app, Action& action);
void add_devices(CLI::App& app, Action& action);
void add_soils(CLI::App& app, Action& action);
void add_machines(CLI::App& app, Action& action);
void add_scenes(CLI::App& app, Action& action);
void add_channels(CLI::App& app, Action& action);
/// Add the soil laboratory and the benchmark.
void add_lab(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);

}  // namespace navvy::cli
