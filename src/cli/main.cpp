// SPDX-License-Identifier: Apache-2.0
// The `navvy` program: a thin client of the library.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "cli/commands.h"
#include "cli/crash.h"
#include "cli/exit_code.h"
#include "cli/import_command.h"
#include "cli/severity.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/log.h"
#include "core/printable.h"
#include "device/device_error.h"

namespace {

using namespace navvy;

/// Installs the sink of the log, which prints to standard error.
void install_log_sink() {
  auto logger = spdlog::stderr_color_mt("navvy");
  logger->set_pattern("%^%l%$: %v");
  // Faults contain their severity and need no prefix.
  auto bare = spdlog::stderr_color_mt("faults");
  bare->set_pattern("%v");
  // Repeated warnings are printed once. The limit bounds the memory of long runs.
  auto logged = std::make_shared<std::set<std::string>>();
  set_log_sink([logger, bare, logged](LogLevel level, const std::string& text) {
    constexpr std::size_t kRemembered = 1000;
    if (level == LogLevel::kWarning && logged->size() < kRemembered && !logged->insert(text).second)
      return;
    if (level >= LogLevel::kWarning && cli::has_severity(text)) {
      bare->warn(text);
      return;
    }
    constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::info, spdlog::level::warn,
                                                     spdlog::level::err};
    logger->log(kLevels[static_cast<int>(level)], text);
  });
}

/// Returns the error of the parser in one line; an unknown option comes with the nearest known one.
std::string complaint(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const std::vector<const CLI::App*> all =
      app.get_subcommands([](const CLI::App*) { return true; });
  const CLI::App* chosen = &app;
  for (const CLI::App* command : all)
    if (argc > 1 && command->get_name() == argv[1]) chosen = command;
  // Every message names the help that explains more.
  const std::string where =
      "(" + (chosen == &app ? "navvy" : "navvy " + chosen->get_name()) + " --help)";
  // A missing argument is named with its description.
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError))
    for (const CLI::Option* option : chosen->get_options())
      if (option->get_required() && option->count() == 0)
        return "`navvy " + chosen->get_name() + "` needs " + option->get_name() + ": " +
               option->get_description() + " " + where;
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError))
    return std::string(error.what()) + " " + where;
  std::vector<std::string> known;
  for (const CLI::Option* option : chosen->get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  // Finds the first unknown option; the word after it may be its value.
  for (int i = 2; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    if (!word.empty() && word.front() == '-' &&
        std::find(known.begin(), known.end(), word) == known.end() && word.size() > 2)
      return "'" + word + "' is no option of `navvy " + chosen->get_name() + "`; " +
             suggestion(word, known) + " " + where;
  }
  return std::string(error.what()) + " " + where;
}

/// Runs an action and gives every kind of failure its exit status (cli/exit_code.h).
int guarded(const cli::Action& action) {
  try {
    return action();
  } catch (const InputError& error) {
    // Faults contain their own severity, and their texts are printable.
    std::cerr << error.what() << "\n";
    return cli::kBadInput;
  } catch (const device::DeviceError& error) {
    // The log of a compiler has several lines.
    std::cerr << printable_lines(error.what()) << "\n";
    return cli::kDevice;
  } catch (const FileError& error) {
    std::cerr << "error: " << printable(error.what()) << "\n";
    return cli::kFile;
  } catch (const SimulationError& error) {
    std::cerr << "error: " << printable_lines(error.what()) << "\n";
    return cli::kSimulation;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << "error: " << printable(error.what()) << "\n";
    return cli::kFile;
  } catch (const std::system_error& error) {
    // A thread that cannot be started, of this program or inside the driver.
    const bool scarce = error.code() == std::errc::resource_unavailable_try_again;
    std::cerr << (scarce ? "error: no further thread can be started: " : "internal error: ")
              << printable(error.what())
              << (scarce ? "; raise the limits of processes (ulimit -u) and of memory (ulimit -v)\n"
                         : "\n");
    return scarce ? cli::kDevice : cli::kInternal;
  } catch (const std::bad_alloc&) {
    // Memory of the host; that of the device has its own error.
    std::cerr << "error: out of memory; use a larger soil cell (--set solver.cell_m=0.15) or a "
                 "smaller site\n";
    return cli::kInternal;
  } catch (const std::exception& error) {
    std::cerr << "internal error: " << printable_lines(error.what()) << "\n";
    return cli::kInternal;
  }
}

/// Closes the help of the program.
constexpr const char* kFooter =
    "Exit status: 0 done, 1 internal error, 2 invalid input, 3 no or failing OpenCL device, 4 a "
    "file could not\n"
    "be written, 5 the simulation failed (it leaves failed.snapshot), 6 the run ended before a "
    "program of it did\n"
    "(see programs in summary.json), 7 `navvy lab` measured a result outside its "
    "tolerance, 8 an event\n"
    "that the scene forbids (navvy:forbid) ended the run, 9 the run missed a goal of the scene "
    "(navvy:goals), 130\n"
    "interrupted (Ctrl-C, SIGTERM, SIGHUP, a controller that went away); above 130 a crash, "
    "which is reported.\n"
    "docs/README.md lists all pages; docs/reference/scene.md has the elements of scene files.";

/// Parses the command line and runs the command.
int run(int argc, char** argv) {
  // The help begins with the command that a newcomer types.
  CLI::App app(
      "Navvy: terrain and excavation simulator on OpenCL.\n"
      "Start with: navvy run scenarios/trench.sdf");
  app.set_version_flag("--version", NAVVY_VERSION);
  // Parsing only fills `action`, which runs after the whole command line is known to be valid.
  app.require_subcommand(1);
  app.footer(kFooter);
  // The chosen subcommand fills the action.
  cli::Action action;
  // The command line is recorded in the folder of a run.
  cli::add_run(app, action, {argv, argv + argc});
  cli::add_show(app, action);
  cli::add_stage(app, action);
  cli::add_check(app, action);
  cli::add_score(app, action);
  cli::add_compare(app, action);
  cli::add_report(app, action);
  cli::add_view(app, action);
  cli::add_import(app, action);
  cli::add_map(app, action);
  cli::add_particles(app, action);
  cli::add_devices(app, action);
  cli::add_scenes(app, action);
  cli::add_machines(app, action);
  cli::add_soils(app, action);
  cli::add_channels(app, action);
  cli::add_schema(app, action);
  cli::add_lab(app, action);
  cli::add_bench(app, action);
  // CLI11 would answer an unknown command with the whole help.
  const std::vector<CLI::App*> commands = app.get_subcommands({});
  const auto is_chosen = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(commands.begin(), commands.end(), is_chosen)) {
    std::vector<std::string> names;
    names.reserve(commands.size());
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    std::cerr << "error: '" << printable(argv[1]) << "' is no command; "
              << suggestion(argv[1], names) << " (navvy --help)\n";
    return cli::kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help and version are no errors.
    if (error.get_exit_code() == 0) return app.exit(error) == 0 ? cli::kOk : cli::kBadInput;
    std::cerr << "error: " << printable(complaint(app, error, argc, argv)) << "\n";
    return cli::kBadInput;
  }
  // Parsing prints its own messages, so the log follows it.
  install_log_sink();
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  // Before any library is used, as their start may crash, too.
  cli::install_crash_report();
  // A closed pipe and a file that exceeds its limit become errors of the call that writes.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  const int status = guarded([&] { return run(argc, argv); });
  cli::expect_exit();
  return status;
}
