// SPDX-License-Identifier: Apache-2.0
// `navvy map`: writes layers of a site to a file, from the folder of a run, a snapshot or a scene.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/input_files.h"
#include "cli/scene_options.h"
#include "cli/validators.h"
#include "control/step_kinds.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/printable.h"
#include "core/sealed.h"
#include "device/device.h"
#include "earthwork/pit_planner.h"
#include "formats/formats.h"
#include "heightfield/make_ground.h"
#include "map/map_maker.h"
#include "map/map_sources.h"
#include "planner/map_path_planner.h"
#include "record/path_file.h"
#include "scene_io/loader.h"
#include "scene_io/ordered_program.h"
#include "scene_io/shipped.h"
#include "session/session.h"
#include "sim/occupied_areas.h"
#include "sim/world_terrain.h"

namespace navvy::cli {
namespace {

/// Options of the command line.
struct MapCommand {
  std::string from, layers, format, out, scene, device;
  bool start = false, paths = false, without_machines = false;
  /// Limits of traversability; 0 means that the map uses its own.
  double slope_deg = 0, step = 0, roughness = 0, window = 0;
};

/// Source of a map, which decides what can be known.
enum class From { kScene, kRun, kSnapshot };

/// Returns the files that a map of `scene` is made from, besides `others`.
std::vector<std::string> reads_of(const scene::Scene& scene, std::vector<std::string> others) {
  others.insert(others.end(), {scene.file, scene.ground.file, scene.design.file});
  return others;
}

/// Returns the reason why a layer is unknown everywhere, and the remedy.
std::pair<std::string, std::string> why_unknown(map::LayerNeeds needs, From from) {
  if (needs == map::LayerNeeds::kDesign)
    return {"the scene has no design", "add a <navvy:design> to the scene"};
  if (needs == map::LayerNeeds::kHistory)
    return {from == From::kScene ? "nothing has changed on an untouched site"
                                 : "a file of one instant holds no history",
            "record it while the scene runs: <navvy:record>"};
  if (from == From::kRun)
    return {"a run's folder holds heights and the depth of loose soil only",
            "map a snapshot of that time: navvy run SCENE --snapshot FILE --snapshot-at T"};
  return {"no column of the site has a value", "look at the site's map with navvy check"};
}

/// Refuses a format that would be empty, and warns of each layer named by the user that is unknown
/// everywhere. Returns the names of unknown layers that the format added by default.
std::string look_for_unknown(const MapCommand& options, const formats::MapFormat& format,
                             const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                             From from) {
  std::string unknown;
  if (format.needs_design && map.has(map::MapLayer::kTarget) &&
      map::unknown_everywhere(map, map::MapLayer::kTarget))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--format", format.name,
                           "holds the soil to be dug, but the scene has no design",
                           "add a <navvy:design> to the scene"});
  for (const map::MapLayer layer : layers) {
    if (!map::unknown_everywhere(map, layer)) continue;
    const std::string& name = map::info(layer).name;
    const auto [why, remedy] = why_unknown(map::info(layer).needs, from);
    if (!options.layers.empty())
      log_warning(Fault{Fault::Severity::kWarning, "", 0, "--layers", name,
                        "is unknown in every column of '" + options.from + "': " + why, remedy}
                      .text());
    else
      unknown += (unknown.empty() ? "" : ",") + name;
  }
  return unknown;
}

/// Loads a scene with the step table of a run: its program is checked, although it does not run
/// here.
scene::Scene load(const std::string& file) {
  return scene_io::load_scene(file, control::step_kinds());
}

map::MapOptions map_options(const MapCommand& options, std::vector<map::MapLayer> layers,
                            const scene::Scene& scene, const heightfield::Terrain& site,
                            const heightfield::DesignSurface* design = nullptr) {
  // A picture of any layer is shaded by the surface.
  layers.push_back(map::MapLayer::kElevation);
  map::MapOptions out = map::options_for(scene, site, std::move(layers), design);
  out.machines = !options.without_machines;
  // Zero stands for "not given".
  if (options.slope_deg > 0) out.limits.slope = radians(options.slope_deg);
  if (options.step > 0) out.limits.step_height = options.step;
  if (options.roughness > 0) out.limits.roughness = options.roughness;
  if (options.window > 0) out.limits.window = options.window;
  return out;
}

/// Makes the map of a snapshot with its active soil. Needs the device, because particles live
/// there.
map::TerrainMap of_snapshot(const MapCommand& options, const formats::MapFormat& format,
                            const std::vector<map::MapLayer>& layers) {
  const std::string scene =
      options.scene.empty() ? scene_in(std::filesystem::path(options.from).parent_path().string(),
                                       "map", options.from)
                            : scene_io::find_scene(options.scene);
  const scene::Scene described = load(scene);
  require_apart(options.out, formats::files_of(format, options.out),
                reads_of(described, {options.from}));
  // The session restores particles as a run would resume from them.
  device::Device device(options.device);
  session::Session session(
      described, device,
      control::Planners{planner::path_planners(), earthwork::job_planners(),
                        scene_io::ordered_program_reader(control::step_kinds())});
  session.load(options.from);
  const sim::World& world = session.world();
  map::MapMaker maker(
      map_options(options, layers, world.description(), world.ground(), session.design()));
  maker.update(sim::terrain_view(world, heightfield::SurfaceKind::kMapped));
  return maker.map();
}

/// A map and its source.
struct Made {
  map::TerrainMap map;
  From from;
};

/// Makes the map of whatever the user named.
Made read(const MapCommand& options, const formats::MapFormat& format,
          const std::vector<map::MapLayer>& layers) {
  // The name is a folder, a file with the header of a snapshot, or else a scene.
  const std::filesystem::path from(options.from);
  std::error_code unreadable;
  if (std::filesystem::is_directory(from, unreadable)) {
    const scene::Scene scene = load(scene_in(options.from, "map", options.from));
    const std::string end = (from / "terrain_end.tif").string();
    require_apart(options.out, formats::files_of(format, options.out),
                  reads_of(scene, {end, (from / "paths.csv").string()}));
    const heightfield::Ground site = heightfield::make_ground(scene);
    const map::MapOptions wanted = map_options(options, layers, scene, site);
    // At the start nothing has moved, so all bodies are known, not only fixed ones.
    if (options.start)
      return {
          map::map_of_site(site, wanted, sim::starting_areas(scene, site, sim::all_bodies(scene))),
          From::kScene};
    // A run's folder does not hold where bodies have moved to.
    return {map::map_of_run(scene, site, end, wanted,
                            sim::starting_areas(scene, site, sim::fixed_bodies(scene))),
            From::kRun};
  }
  if (is_sealed(options.from)) return {of_snapshot(options, format, layers), From::kSnapshot};
  const scene::Scene scene = load(scene_io::find_scene(options.from));
  require_apart(options.out, formats::files_of(format, options.out), reads_of(scene, {}));
  const heightfield::Ground site = heightfield::make_ground(scene);
  return {map::map_of_site(site, map_options(options, layers, scene, site),
                           sim::starting_areas(scene, site, sim::all_bodies(scene))),
          From::kScene};
}

int map(const MapCommand& options) {
  // Names and the output path are checked before anything expensive.
  const formats::MapFormat& format = formats::format_named(options.format);
  const std::vector<map::MapLayer> layers =
      options.layers.empty() ? format.by_default : map::layers_named(options.layers);
  formats::require_writable(format, options.out);
  if (options.paths && format.write_with_lines == nullptr)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--paths", format.name,
                           "only hillshade and relief show paths",
                           "ask for one of those, or read the run's paths.csv"});
  std::vector<map::MapLine> lines;
  if (options.paths) {
    const std::string file = (std::filesystem::path(options.from) / "paths.csv").string();
    std::error_code unreadable;
    if (!std::filesystem::is_regular_file(file, unreadable))
      throw InputError(Fault{Fault::Severity::kError, "", 0, "--paths", options.from,
                             "holds no paths.csv",
                             "give the folder of a run whose program has a go_to"});
    lines = record::read_paths(file);
  }
  const auto [made, from] = read(options, format, layers);
  const std::string unknown = look_for_unknown(options, format, made, layers, from);
  if (options.paths)
    format.write_with_lines(made, layers, options.out, lines);
  else
    format.write(made, layers, options.out);
  // Prints one line about the result.
  std::string names;
  for (const map::MapLayer layer : layers)
    names += (names.empty() ? "" : ",") + map::info(layer).name;
  char when[40] = "";
  // The files of a run do not hold the time.
  if (made.time() == made.time()) std::snprintf(when, sizeof when, " at %g s", made.time());
  if (!unknown.empty()) names += "; unknown everywhere: " + unknown;
  std::printf("map: %s, %s, %d x %d columns of %g m%s: %s\n", printable(options.out).c_str(),
              format.name.c_str(), made.nx(), made.ny(), made.cell(), when, names.c_str());
  return kOk;
}

/// Returns the list of layers and formats for --help, from their tables.
std::string footer() {
  std::string out = "Layers:\n";
  char line[160];
  for (const map::LayerInfo& each : map::layers()) {
    std::snprintf(line, sizeof line, "  %-16s %-6s %s\n", each.name.c_str(), each.unit.c_str(),
                  each.meaning.c_str());
    out += line;
  }
  out += "Formats:\n";
  for (const formats::MapFormat& each : formats::all_formats()) {
    std::snprintf(line, sizeof line, "  %-16s %-6s %s\n", each.name.c_str(), each.extension.c_str(),
                  each.meaning.c_str());
    out += line;
  }
  return out +
         "Examples: navvy map out/trench --format nav2 --out trench.yaml\n"
         "          navvy map out/trench --layers elevation,slope,traversability --format geotiff "
         "--out trench.tif\n"
         "src/map/README.md gives formulas, axes and what each format holds.";
}

}  // namespace

void add_map(CLI::App& app, Action& action) {
  // The action keeps it alive after parsing.
  auto options = std::make_shared<MapCommand>();
  CLI::App* command = app.add_subcommand(
      "map", "write layers of a site for planners: GeoTIFF, NPZ, nav2, PLY, pictures");
  command
      ->add_option(
          "from", options->from,
          "a run's folder (the ground at its end), a snapshot, or a scene (the untouched site)")
      ->required();
  command->add_option("--layers", options->layers,
                      "names separated by commas; without it the default layers of the format");
  command->add_option("--format", options->format, "see below")->required();
  command
      ->add_option("--out", options->out,
                   "the file or folder to write; replaced whole or not at all")
      ->required();
  command->add_flag("--start", options->start, "for a run: the ground at its start");
  command->add_flag("--without-machines", options->without_machines,
                    "leave machines out of occupied, traversability and occupancy");
  command->add_flag("--paths", options->paths,
                    "for a run with a go_to: draw its planned paths on a hillshade or relief");
  command->add_option("--scene", options->scene,
                      "for a snapshot: its scene; without it scene.sdf beside the snapshot");
  command->add_option("--device", options->device,
                      "for a snapshot: the OpenCL device, as in `navvy run`");
  const auto limit = [&](const char* name, double& to, const char* meaning) {
    command->add_option(name, to, meaning)->check(above_zero);
  };
  limit("--slope-limit-deg", options->slope_deg,
        "slope that is not traversable (the machine's, else 30)");
  limit("--step-limit", options->step,
        "step height that is not traversable [m] (the machine's, else 0.3)");
  limit("--roughness-limit", options->roughness,
        "rms roughness that is not traversable [m] (the machine's, else 0.1)");
  limit("--window", options->window,
        "half the side of the square used for step and roughness [m] (the machine's, else 0.2)");
  command->footer(footer());
  command->callback([options, &action] { action = [options] { return map(*options); }; });
}

}  // namespace navvy::cli
