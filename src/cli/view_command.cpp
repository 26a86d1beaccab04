// SPDX-License-Identifier: Apache-2.0
// `navvy view`: the page of a run, served to browsers of this machine.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "core/printable.h"
#include "link/run_view.h"
#include "run/stop_signals.h"

namespace navvy::cli {

void add_view(CLI::App& app, Action& action) {
  struct Options {
    std::string run;
    int port = 0;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "view", "serve the page of a run to browsers of this machine, also while the run goes on");
  command->add_option("run", options->run, "folder of a run")->required();
  command->add_option("--port", options->port, "port on 127.0.0.1; 0: any free one (0)")
      ->check(CLI::Range(0, 65535));
  command->footer(
      "Prints the address, which contains a secret token, and serves until Ctrl-C. To pause and\n"
      "command a run, start it with `navvy run SCENE --view PORT`.");
  command->callback([options, &action] {
    action = [options] {
      // Before the threads of the server. Reading a folder leaves nothing to close.
      run::StopSignals signals([](const char*) { _exit(kInterrupted); });
      link::RunView view(options->run, options->port);
      std::printf("view: %s\n", printable(view.address()).c_str());
      std::fflush(stdout);
      while (!run::StopSignals::asked()) {
        view.step();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
      signals.obeyed();
      return kOk;
    };
  });
}

}  // namespace navvy::cli
