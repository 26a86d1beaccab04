// SPDX-License-Identifier: Apache-2.0
#include "cli/import_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/exit_code.h"
#include "core/printable.h"
#include "scene_io/machine_import.h"

namespace navvy::cli {
namespace {

/// Options as parsed.
struct Options {
  std::string file;
  scene_io::ImportOptions import;
};

/// Writes the machine and prints what was made of it.
int import(const Options& options) {
  for (const std::string& sentence : scene_io::import_machine(options.file, options.import))
    std::printf("%s\n", printable(sentence).c_str());
  std::printf("machine: %s/model.sdf\n", options.import.folder.c_str());
  return kOk;
}

}  // namespace

void add_import(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "import",
      "write a machine of SDF or URDF as one of Navvy, with wheels, drive, arm and bucket");
  command->add_option("file", options->file, "SDF or URDF file of one machine")->required();
  command->add_option("--out", options->import.folder, "folder for model.sdf, meshes and IMPORT.md")
      ->required();
  command
      ->add_option("--mass-from-density", options->import.density,
                   "density [kg/m3] by which links with a placeholder for a mass get one")
      ->check(CLI::Range(1.0, 25000.0));
  command->add_option("--masses", options->import.masses,
                      "file with lines link,mass_kg that replace masses of the file");
  command->callback([options, &action] { action = [options] { return import(*options); }; });
}

}  // namespace navvy::cli
