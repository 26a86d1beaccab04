// SPDX-License-Identifier: Apache-2.0
// The subcommands of `navvy`: each adds its options to the parser and leaves its work in `action`.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace navvy::cli {

/// What the chosen subcommand does; returns the exit status.
using Action = std::function<int()>;

void add_run(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_devices(CLI::App& app, Action& action);
void add_soils(CLI::App& app, Action& action);
void add_channels(CLI::App& app, Action& action);
void add_lab(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);

}  // namespace navvy::cli
