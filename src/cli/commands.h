// SPDX-License-Identifier: Apache-2.0
// The subcommands of `navvy`. Each function adds a subcommand with its options to the command line
// parser. Parsing stores the work of the chosen subcommand in `action`.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
/// The command line parser of CLI11. It takes seconds to compile, so headers only declare it.
class App;
}  // namespace CLI

namespace navvy::cli {

/// Function that runs the chosen subcommand and returns the exit status of the process.
using Action = std::function<int()>;

/// Adds `navvy run`, which runs a scene. `command_line` contains the program and its arguments; it
/// is recorded in the output folder.
void add_run(CLI::App& app, Action& action, std::vector<std::string> command_line);
/// Adds `navvy map`, which writes map layers of a site to a file.
void add_map(CLI::App& app, Action& action);
/// Adds `navvy particles`, which writes the active soil of a snapshot or scene to a file.
void add_particles(CLI::App& app, Action& action);
/// Adds `navvy show`, which draws a scene before its run.
void add_show(CLI::App& app, Action& action);
/// Adds `navvy stage`, which writes a snapshot of a scene whose job is done in part.
void add_stage(CLI::App& app, Action& action);
/// Adds `navvy check`, which reports errors in input files.
void add_check(CLI::App& app, Action& action);
/// Adds `navvy score`, which prints the score of a run.
void add_score(CLI::App& app, Action& action);
/// Adds `navvy compare`, which compares the scores of two runs.
void add_compare(CLI::App& app, Action& action);
/// Adds `navvy report`, which makes the page of a run, or of two.
void add_report(CLI::App& app, Action& action);
/// Adds `navvy view`, which serves the page of a run to browsers.
void add_view(CLI::App& app, Action& action);
/// Adds `navvy devices`, which lists the OpenCL devices.
void add_devices(CLI::App& app, Action& action);
/// Adds `navvy soils`, which lists the shipped soils, or the values of one soil.
void add_soils(CLI::App& app, Action& action);
/// Adds `navvy machines`, which lists the shipped machines, or the parts of one machine.
void add_machines(CLI::App& app, Action& action);
/// Adds `navvy scenes`, which lists the shipped scenes.
void add_scenes(CLI::App& app, Action& action);
/// Adds `navvy channels`, which lists the inputs, outputs and arrays of a scene.
void add_channels(CLI::App& app, Action& action);
/// Adds `navvy schema`, which prints the elements that scene files may contain.
void add_schema(CLI::App& app, Action& action);
/// Adds `navvy lab`, which runs an experiment of the virtual soil laboratory.
void add_lab(CLI::App& app, Action& action);
/// Adds the ratings of machines to `navvy lab`: the subcommands iso6015 and iso10567.
void add_ratings(CLI::App& lab, Action& action);
/// Adds `navvy lab iso11152`, which compares the energy of a motion with and without soil.
void add_motion_energy(CLI::App& lab, Action& action);
/// Adds `navvy bench`, which measures the speed of the soil simulation.
void add_bench(CLI::App& app, Action& action);

}  // namespace navvy::cli
