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
/// Adds `navvy check`, which reports faults of files.
void add_check(CLI::App& app, Action& action);
/// Adds `navvy devices`, which lists OpenCL devices.
void add_devices(CLI::App& app, Action& action);
/// Adds `navvy soils`, which lists shipped soils or the values of one.
void add_soils(CLI::App& app, Action& action);
/// Adds `navvy machines`, which lists shipped machines or the parts of one.
void add_machines(CLI::App& app, Action& action);
/// Adds `navvy scenes`, which lists shipped scenes.
void add_scenes(CLI::App& app, Action& action);
/// Adds `navvy channels`, which lists inputs, outputs and arrays of a scene.
void add_channels(CLI::App& app, Action& action);
/// Adds `navvy schema`, which prints the elements of scene files.
void add_schema(CLI::App& app, Action& action);
/// Adds `navvy lab`, the virtual soil laboratory.
void add_lab(CLI::App& app, Action& action);
/// Adds `navvy bench`, which measures the speed of the soil.
void add_bench(CLI::App& app, Action& action);

}  // namespace navvy::cli
