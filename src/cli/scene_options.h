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

struct SceneOptions {
  std::string file;
  std::string device;
  std::vector<std::string> set;
  std::string terrain, at, size;
  std::optional<std::uint64_t> seed;
  double duration = 0;
  bool no_render = false;

  /// Adds those that change a scene's values (--set, --seed, --terrain, --at, --size); the struct must outlive parsing.
  void add_values_to(CLI::App& command);
  /// Adds all options to a subcommand; the struct must outlive parsing.
  void add_to(CLI::App& command);
  /// @throws InputError for a malformed value.
  scene_io::Overrides overrides() const;
  /// The scene with its overrides. @throws InputError.
  scene::World load() const;
};

}  // namespace navvy::cli
