// SPDX-License-Identifier: Apache-2.0
// `navvy report`: the page of a run, or of two side by side.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "core/printable.h"
#include "report/page.h"

namespace navvy::cli {
namespace {

namespace fs = std::filesystem;

/// Returns the name of a folder, also if it ends with a slash.
std::string name_of(const std::string& folder) {
  const fs::path path = fs::path(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

/// Returns the page of one run in its folder, and of two in the folder of the first.
std::string default_file(const std::vector<std::string>& runs) {
  const fs::path folder = runs.front();
  if (runs.size() == 1) return (folder / report::kPageName).string();
  return (folder / ("report_and_" + name_of(runs.back()) + ".html")).string();
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  struct Options {
    std::vector<std::string> runs;
    std::string out;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "report", "make the page of a run: outcome, charts, map, 3D view over time; or of two runs");
  command->add_option("run", options->runs, "folder of a run, or of two to compare")
      ->required()
      ->expected(1, 2);
  command->add_option("--out", options->out, "HTML file (RUN/report.html)");
  command->footer(
      "The page is one file of at most 5 MB that any browser shows without a network.\n"
      "Every run makes its page at its end; this makes it again, also of a run that was killed.");
  command->callback([options, &action] {
    action = [options] {
      const std::string file = options->out.empty() ? default_file(options->runs) : options->out;
      report::write_page(options->runs, file);
      std::printf("%s\n", printable(file).c_str());
      return kOk;
    };
  });
}

}  // namespace navvy::cli
