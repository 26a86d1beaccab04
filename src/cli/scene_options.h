// SPDX-License-Identifier: Apache-2.0
// Options that every command on a scene shares.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene_io/loader.h"

namespace CLI {
class App;
}

namespace navvy::cli {

/// A scene and the changes to it, as given on the command line. The parser fills it before the
/// command runs.
struct SceneOptions {
  /// Path, or name of a shipped scene, as typed.
  std::string file;
  /// OpenCL device, as device::Device takes it. Empty: the environment decides.
  std::string device;
  /// Settings, KEY=VALUE each.
  std::vector<std::string> set;
  /// Values of --terrain, --at and --size as text. `overrides` parses them, so that an error names
  /// its option.
  std::string terrain, at, size;
  /// Seed of the scene; empty: its own.
  std::optional<std::uint64_t> seed;
  /// Maximum simulated time [s]; 0: that of the scene.
  double duration = 0;
  /// True to draw no pictures.
  bool no_render = false;

  /// Adds the options that change a scene's values (--set, --seed, --terrain, --at, --size). The
  /// struct must stay alive until the command has run.
  void add_values_to(CLI::App& command);
  /// Adds all options to a subcommand. The struct must stay alive until the command has run.
  void add_to(CLI::App& command);
  /// Returns the changes for the loader. @throws InputError for a malformed value.
  scene_io::Overrides overrides() const;
  /// Loads the scene with its changes. `resolved` is as in scene_io::load_scene. @throws
  /// InputError.
  scene::Scene load(std::string* resolved = nullptr) const;
};

}  // namespace navvy::cli
