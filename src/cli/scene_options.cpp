// SPDX-License-Identifier: Apache-2.0
#include "cli/scene_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "cli/validators.h"
#include "control/step_kinds.h"
#include "core/error.h"
#include "scene/overlay.h"
#include "scene_io/shipped.h"

namespace navvy::cli {
namespace {

/// Returns the two numbers of "X,Y" [m]. @throws InputError that names the option.
Vec2 parse_pair(const std::string& option, const std::string& text) {
  // The whole text must be two numbers: "1,2m" is a mistake.
  std::size_t used = 0, rest = 0;
  try {
    const double x = std::stod(text, &used);
    if (used < text.size() && text[used] == ',') {
      const double y = std::stod(text.substr(used + 1), &rest);
      if (used + 1 + rest == text.size() && std::isfinite(x) && std::isfinite(y)) return Vec2(x, y);
    }
  } catch (const std::exception&) {
    // The message below covers it.
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, option, text,
                         "two numbers in metres, separated by a comma",
                         "for example " + option + " 120,80"});
}

/// Returns the names of all overlays for --help.
std::string overlay_names() {
  std::string out;
  for (const scene::OverlayInfo& one : scene::overlays())
    out += (out.empty() ? "" : ",") + std::string(one.name);
  return out;
}

}  // namespace

void SceneOptions::add_values_to(CLI::App& command) {
  command
      .add_option("--preset", preset,
                  "planning: cells of 0.2 m, for a third of the time and coarser results; --set "
                  "overrides it")
      ->check(CLI::IsMember({"planning"}));
  // One value each: otherwise the scene's name after it would count as a second one.
  command
      .add_option("--set", set,
                  "override a value of the scene, e.g. soil.cohesion_pa=8000; repeatable")
      ->allow_extra_args(false);
  command
      .add_option("--seed", seed, "seed of encoder noise and of hills without a seed of their own")
      ->check(whole_number);
  command.add_option("--terrain", terrain,
                     "heightmap (GeoTIFF, ESRI ASCII) instead of the scene's ground");
  command.add_option(
      "--at", at,
      "X,Y of the site's centre in the file's coordinates, or local:X,Y from its lower-left "
      "corner; default its centre");
  command.add_option("--size", size, "X,Y extent of the site [m]");
  command.add_option(
      "--soil", soil,
      "soil of the site: the name of a shipped one or a file; for a world of another "
      "simulator, which has none, or instead of the scene's one soil");
}

void SceneOptions::add_scene_to(CLI::App& command) {
  command.add_option("scene", file, "scene file (SDF), or the name of a shipped scene")->required();
  command.add_option("--device", device,
                     "OpenCL device: cpu, gpu, an index or a part of a name (see `navvy devices`); "
                     "without it NAVVY_DEVICE decides");
}

void SceneOptions::add_overlays_to(CLI::App& command) {
  command
      .add_option("--show", show,
                  "overlays in pictures instead of the scene's, separated by commas: " +
                      overlay_names() + "; one of the last four colors soil")
      ->allow_extra_args(false);
}

void SceneOptions::add_to(CLI::App& command) {
  // Options of a run beside values.
  add_scene_to(command);
  add_values_to(command);
  command.add_option("--duration", duration, "maximum simulated time [s]")->check(above_zero);
  command.add_flag("--no-render", no_render, "draw no pictures");
}

scene_io::Overrides SceneOptions::overrides() const {
  scene_io::Overrides out;
  // The loader applies changes to the text before it reads, so that the same rules hold for both.
  if (preset == "planning") out.set.push_back(scene_io::parse_setting("solver.cell_m=0.2"));
  for (const std::string& setting : set) out.set.push_back(scene_io::parse_setting(setting));
  out.seed = seed;
  // 0 means that it was not given.
  if (duration > 0) out.duration = duration;
  if (no_render) out.render = false;
  if (!terrain.empty()) out.terrain = terrain;
  if (!at.empty()) {
    // A prefix instead of another option, as both forms give the same value.
    const std::string local = "local:";
    out.at_is_local = at.rfind(local, 0) == 0;
    out.at = parse_pair("--at", out.at_is_local ? at.substr(local.size()) : at);
  }
  if (!soil.empty()) out.soil = soil;
  if (show) {
    out.show = *show;
    std::replace(out.show->begin(), out.show->end(), ',', ' ');
  }
  if (!size.empty()) out.size = parse_pair("--size", size);
  return out;
}

scene::Scene SceneOptions::load(std::string* resolved) const {
  return scene_io::load_scene(scene_io::find_scene(file), control::step_kinds(), overrides(),
                              resolved);
}

}  // namespace navvy::cli
