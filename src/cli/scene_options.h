// SPDX-License-Identifier: Apache-2.0
// Command line options shared by all subcommands that use a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene_io/loader.h"

namespace CLI {
/// The command line parser of CLI11.
class App;
}  // namespace CLI

namespace navvy::cli {

/// A scene file and changes to it, as given on the command line. The parser fills this struct
/// before the subcommand runs.
struct SceneOptions {
  /// Path of a scene file, or name of a shipped scene.
  std::string file;
  /// OpenCL device as described at device::Device. Empty: the environment variable NAVVY_DEVICE
  /// selects it.
  std::string device;
  /// Name of a set of changed values, which come before those of `set`; empty for none.
  std::string preset;
  /// Changed values of the scene, each as KEY=VALUE.
  std::vector<std::string> set;
  /// Values of the options --terrain, --at and --size as text. They are parsed by `overrides`, so
  /// that error messages can name the option.
  std::string terrain, at, size;
  /// Name or file of the site's soil; empty: that of the scene.
  std::string soil;
  /// Names of overlays, separated by commas; no value: those of the scene.
  std::optional<std::string> show;
  /// Seed that replaces the scene's seed, if given.
  std::optional<std::uint64_t> seed;
  /// Maximum simulated time [s]; 0 for the duration in the scene.
  double duration = 0;
  /// True to draw no pictures.
  bool no_render = false;

  /// Adds the options that change values of the scene to `command`: --preset, --set, --seed,
  /// --terrain,
  /// --at, --size and --soil. This struct must stay alive until the command has run.
  void add_values_to(CLI::App& command);
  /// Adds the scene argument and --device to `command`. This struct must stay alive until the
  /// command has run.
  void add_scene_to(CLI::App& command);
  /// Adds --show to `command`. This struct must stay alive until the command has run.
  void add_overlays_to(CLI::App& command);
  /// Adds all options but --show, and the scene argument, to `command`. This struct must stay alive
  /// until the command has run.
  void add_to(CLI::App& command);
  /// Returns the changes to the scene, for the loader. @throws InputError for a malformed value.
  scene_io::Overrides overrides() const;
  /// Loads the scene and applies the changes. If `resolved` is not null, it receives the text of
  /// the resulting scene, as for scene_io::load_scene. @throws InputError.
  scene::Scene load(std::string* resolved = nullptr) const;
};

}  // namespace navvy::cli
