// SPDX-License-Identifier: Apache-2.0
// `navvy particles`: writes the active soil of a snapshot, or of a scene at its start, to a file.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/input_files.h"
#include "control/step_kinds.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/printable.h"
#include "core/sealed.h"
#include "formats/particle_files.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "scene_io/ordered_program.h"
#include "scene_io/shipped.h"
#include "sim/read_particles.h"

namespace navvy::cli {
namespace {

/// Options of the command line.
struct ParticlesCommand {
  std::string from, out, scene, device;
};

/// Refuses the folder of a run, which holds no particles.
void require_no_folder(const std::string& from) {
  std::error_code unreadable;
  if (!std::filesystem::is_directory(from, unreadable)) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "particles", from,
                         "is a folder; the folder of a run holds no active soil",
                         "name a snapshot of the run (navvy run SCENE --snapshot FILE "
                         "--snapshot-at T), or record with navvy run SCENE --particles 10"});
}

/// Returns the file of the scene to which the particles belong. @throws InputError where there is
/// none, and for a --scene that nothing needs.
std::string scene_of(const ParticlesCommand& options, bool snapshot) {
  if (!snapshot && !options.scene.empty())
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--scene", options.scene,
                           "names the scene of a snapshot, but '" + options.from + "' is none",
                           "omit it, or name a snapshot"});
  if (!options.scene.empty()) return scene_io::find_scene(options.scene);
  if (!snapshot) return scene_io::find_scene(options.from);
  return scene_in(std::filesystem::path(options.from).parent_path().string(), "particles",
                  options.from);
}

int particles(const ParticlesCommand& options) {
  // Names and the output path are checked before anything expensive.
  const formats::ParticleFormat& format = formats::particle_format_of(options.out, "--out");
  require_writable(options.out);
  require_no_folder(options.from);
  const bool snapshot = is_sealed(options.from);
  const std::string file = scene_of(options, snapshot);
  scene::Scene scene = scene_io::load_scene(file, control::step_kinds());
  require_apart(options.out, {options.out},
                {options.from, scene.file, scene.ground.file, scene.design.file});
  run::SimulationOptions wanted;
  wanted.device = options.device;
  wanted.read_program = scene_io::ordered_program_reader(control::step_kinds());
  run::Simulation simulation(std::move(scene), wanted);
  // Not SimulationOptions::resume, which refuses the snapshot of a run that is done.
  if (snapshot) simulation.load(options.from);
  const scene::ParticleTable table = sim::read_particles(simulation.world());
  format.write(table, options.out);
  if (table.count() == 0)
    log_warning("'" + printable(options.from) +
                "' has no active soil, so the file has no particles");
  double mass = 0;
  for (const double one : table.mass) mass += one;
  std::printf("particles: %s, %s, %zu particles of %.6g kg at %g s\n",
              printable(options.out).c_str(), format.name.c_str(), table.count(), mass, table.time);
  return kOk;
}

/// Returns the formats and quantities for --help, from their tables.
std::string footer() {
  std::string out = "Formats, by the ending of --out:\n";
  char line[200];
  for (const formats::ParticleFormat& each : formats::particle_formats()) {
    std::snprintf(line, sizeof line, "  %-18s %s\n", each.extension.c_str(), each.meaning.c_str());
    out += line;
  }
  out += "Quantities of each particle:\n";
  const scene::ParticleTable none;
  for (const scene::ParticleArray& each : none.arrays()) {
    std::snprintf(line, sizeof line, "  %-18s %-6s %s\n", each.name.c_str(), each.unit.c_str(),
                  each.meaning.c_str());
    out += line;
  }
  return out +
         "Example: navvy particles half.snapshot --scene trench --out half.vtu\n"
         "docs/howto/particles.md describes the files. navvy run --particles records them over "
         "time.";
}

}  // namespace

void add_particles(CLI::App& app, Action& action) {
  // The action keeps it alive after parsing.
  auto options = std::make_shared<ParticlesCommand>();
  CLI::App* command = app.add_subcommand(
      "particles", "write the active soil of a snapshot or scene: NPZ, VTU, PLY");
  command
      ->add_option("from", options->from, "a snapshot, or a scene (its active soil at the start)")
      ->required();
  command
      ->add_option("--out", options->out,
                   "the file to write; its ending names the format; replaced whole or not at all")
      ->required();
  command->add_option("--scene", options->scene,
                      "for a snapshot: its scene; without it scene.sdf beside the snapshot");
  command->add_option("--device", options->device, "the OpenCL device, as in `navvy run`");
  command->footer(footer());
  command->callback([options, &action] { action = [options] { return particles(*options); }; });
}

}  // namespace navvy::cli
