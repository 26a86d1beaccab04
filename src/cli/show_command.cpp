// SPDX-License-Identifier: Apache-2.0
// `navvy show`: draws a scene as a camera sees it before the run.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/printable.h"
#include "device/device.h"
#include "earthwork/pit_planner.h"
#include "planner/map_path_planner.h"
#include "record/camera_pictures.h"
#include "scene/overlay.h"
#include "session/session.h"

namespace navvy::cli {
namespace {

/// Options of the command line.
struct ShowCommand {
  SceneOptions scene;
  std::string camera, out;
};

/// Returns the name of the camera to draw: the one asked for, or the first one.
std::string camera_of(const ShowCommand& options, const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Camera& one : scene.cameras) names.push_back(one.name);
  if (names.empty())
    throw InputError(Fault{Fault::Severity::kError, scene.file, 0, "navvy:camera", "",
                           "the scene has no camera",
                           "add a <navvy:camera> with <frame>all</frame>"});
  if (options.camera.empty()) return names.front();
  if (std::find(names.begin(), names.end(), options.camera) == names.end())
    throw InputError(Fault{Fault::Severity::kError, scene.file, 0, "--camera", options.camera,
                           "is no camera of the scene", suggestion(options.camera, names)});
  return options.camera;
}

int show(const ShowCommand& options) {
  const scene::Scene scene = options.scene.load();
  const std::string camera = camera_of(options, scene);
  std::string out = options.out;
  if (out.empty()) out = scene.name + "_" + camera + ".png";
  if (std::filesystem::path(out).extension() != ".png")
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--out", out, "pictures are PNG files",
                           "end the name in .png"});
  device::Device device(options.scene.device);
  const session::Session session(
      scene, device, control::Planners{planner::path_planners(), earthwork::job_planners()});
  const render::Image image = record::CameraPictures(session).draw(camera);
  render::write_png(out, image);
  std::printf("%s: camera '%s' of '%s', %d x %d pixels\n", printable(out).c_str(),
              printable(camera).c_str(), printable(scene.name).c_str(), image.width, image.height);
  return kOk;
}

/// Returns the list of overlays for --help.
std::string footer() {
  std::string out = "Overlays:\n";
  char line[160];
  for (const scene::OverlayInfo& one : scene::overlays()) {
    std::snprintf(line, sizeof line, "  %-12s %s\n", one.name, one.text);
    out += line;
  }
  return out + "Example: navvy show trench --camera overview --show grid,joints,person,hud";
}

}  // namespace

void add_show(CLI::App& app, Action& action) {
  auto options = std::make_shared<ShowCommand>();
  CLI::App* command = app.add_subcommand("show", "draw a scene as a camera sees it before the run");
  options->scene.add_scene_to(*command);
  options->scene.add_values_to(*command);
  options->scene.add_overlays_to(*command);
  command->add_option("--camera", options->camera, "name of the camera; without it the first one");
  command->add_option("--out", options->out,
                      "PNG file to write; without it SCENE_CAMERA.png in the working directory");
  command->footer(footer());
  command->callback([options, &action] { action = [options] { return show(*options); }; });
}

}  // namespace navvy::cli
