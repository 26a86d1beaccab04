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

/// The scene to load and what to change in it; filled by the parser, read by the action afterwards.
struct SceneOptions {
  /// As typed: a path, or the name of a shipped scene.
  std::string file;
  /// As device::Device takes it; empty: the environment decides.
  std::string device;
  /// KEY=VALUE each.
  std::vector<std::string> set;
  /// Still as text: parsed with the others, so that a slip names its option.
  std::string terrain, at, size;
  std::optional<std::uint64_t> seed;
  /// Most simulated time [s]; 0: the scene's own.
  double duration = 0;
  bool no_render = false;

  /// Adds those that change a scene's values (--set, --seed, --terrain, --at, --size); the struct
  /// must outlive parsing.
  void add_values_to(CLI::App& command);
  /// Adds all options to a subcommand; the struct must outlive parsing.
  void add_to(CLI::App& command);
  /// @throws InputError for a malformed value.
  scene_io::Overrides overrides() const;
  /// The scene with its overrides; `resolved` as in scene_io::load_scene. @throws InputError.
  scene::Scene load(std::string* resolved = nullptr) const;
};

}  // namespace navvy::cli
