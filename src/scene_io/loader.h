// SPDX-License-Identifier: Apache-2.0
// Reads worlds, machines and soils from SDF 1.9 files with `navvy:` extension elements
// (scenarios/README.md documents them all). Every reader collects all faults of all files involved
// before it throws; warnings go to core/log.h.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/math.h"
#include "scene/machine.h"
#include "scene/scene.h"
#include "scene/soil.h"
#include "scene/step_kind.h"

namespace navvy::scene_io {

/// What the command line changes in a scene file before it is read, so that the same rules apply.
struct Overrides {
  /// Pairs such as {"soil[loam].cohesion_pa", "8000"}: `<object>.<element>` or deeper, `[name]` or
  /// `[1]` picks one of several, without it all of them change. Objects are the elements of a
  /// world, without "navvy:".
  std::vector<std::pair<std::string, std::string>> set;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration;  ///< [s]
  std::optional<bool> render;
  std::optional<std::string>
      terrain;  ///< heightmap file, relative to the working directory; replaces procedural shapes
  std::optional<Vec2> at;    ///< centre of the crop [m]
  bool at_is_local = false;  ///< `at` counts from the file's lower-left corner
  std::optional<Vec2> size;  ///< extent of the site [m]
};

/// Splits "KEY=VALUE". @throws InputError when there is no '='.
std::pair<std::string, std::string> parse_setting(const std::string& text);

/// Reads a world with everything it includes. `kinds` are the program steps that are known, as a
/// rule control::step_kinds(); any other step is an error. `resolved`, when given, receives the
/// scene as a text that stands for itself: overrides and included files written out, see
/// resolved.h. Reading that text gives the same world again.
/// @throws InputError with all faults (errors and warnings), also when the file cannot be read.
scene::Scene load_scene(const std::string& file, const scene::StepKinds& kinds,
                        const Overrides& overrides = {}, std::string* resolved = nullptr);
/// The same from memory; `name` stands for the file in messages, relative paths count from its
/// directory.
scene::Scene load_scene_from_string(const std::string& text, const std::string& name,
                                    const scene::StepKinds& kinds, const Overrides& overrides = {},
                                    std::string* resolved = nullptr);

/// Reads a machine (an SDF file with one model). @throws InputError
scene::Machine load_machine(const std::string& file);

/// Reads every *.sdf of a directory, sorted by name. @throws InputError
std::vector<scene::Soil> load_soils(const std::string& directory);

/// How many faults a file has: of very many only the first are told one by one.
struct FaultCount {
  std::size_t errors = 0, warnings = 0;
};

/// All faults of a world, machine or soil file; empty when it is in order. `world` receives the
/// scene when the file is one without errors, else it is left empty. Throws nothing but
/// std::bad_alloc. `overrides` change a scene's values before they are read; `machine` receives the
/// machine of a machine file, `count` the number of all faults, also of those that the list leaves
/// out.
std::vector<Fault> check(const std::string& file, const scene::StepKinds& kinds,
                         std::optional<scene::Scene>* world = nullptr,
                         const Overrides& overrides = {},
                         std::optional<scene::Machine>* machine = nullptr,
                         FaultCount* count = nullptr);

/// Where shipped data (vehicles/, terrain/, scenarios/) is looked for, first match wins:
/// $NAVVY_DATA_DIR, the installation, the source tree.
std::vector<std::string> data_directories();
/// First existing `relative` under `data_directories()`; empty when there is none.
std::string find_data(const std::string& relative);

}  // namespace navvy::scene_io
