// SPDX-License-Identifier: Apache-2.0
// Reads worlds, machines and soils from SDF 1.9 files with `navvy:` extension elements
// (docs/reference/scene.md lists them all). Every reader collects all faults of all files involved
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

/// Changes of a scene from the command line. They are made before the file is read, so that the
/// same rules apply.
struct Overrides {
  /// Pairs such as {"soil[loam].cohesion_pa", "8000"}: `<object>.<element>` or deeper. `[name]` or
  /// `[1]` selects one of several objects, else all of them change; an object below the first can
  /// also be named by a part of its own, as in machine.digger.uri. Objects are the elements of a
  /// world, without "navvy:".
  std::vector<std::pair<std::string, std::string>> set;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration;  ///< [s]
  std::optional<bool> render;
  /// Heightmap file, relative to the working directory; it replaces procedural shapes.
  std::optional<std::string> terrain;
  std::optional<Vec2> at;    ///< centre of the crop [m]
  bool at_is_local = false;  ///< `at` counts from the file's lower-left corner
  std::optional<Vec2> size;  ///< extent of the site [m]
};

/// Splits "KEY=VALUE". @throws InputError without a '='.
std::pair<std::string, std::string> parse_setting(const std::string& text);

/// Reads a world with all that it includes.
///
/// @param kinds the known program steps, as a rule control::step_kinds(); others are errors @param
/// resolved receives the scene as one text, see resolved.h; may be null @throws InputError with all
/// faults, also if the file cannot be read
scene::Scene load_scene(const std::string& file, const scene::StepKinds& kinds,
                        const Overrides& overrides = {}, std::string* resolved = nullptr);
/// Reads a world from memory. `name` stands for the file in messages, and relative paths count from
/// its directory.
scene::Scene load_scene_from_string(const std::string& text, const std::string& name,
                                    const scene::StepKinds& kinds, const Overrides& overrides = {},
                                    std::string* resolved = nullptr);

/// Reads a machine from an SDF file with one model. @throws InputError
scene::Machine load_machine(const std::string& file);

/// Reads the soils of every *.sdf in a directory, sorted by name. @throws InputError
std::vector<scene::Soil> load_soils(const std::string& directory);

/// Number of all faults of a file, of which only the first are shown.
struct FaultCount {
  std::size_t errors = 0, warnings = 0;
};

/// Returns the faults of a world, machine or soil file, with `overrides` applied to a world.
/// `world` or `machine` receives what the file holds if it has no errors, `count` the number of all
/// faults. Throws nothing but std::bad_alloc.
std::vector<Fault> check(const std::string& file, const scene::StepKinds& kinds,
                         std::optional<scene::Scene>* world = nullptr,
                         const Overrides& overrides = {},
                         std::optional<scene::Machine>* machine = nullptr,
                         FaultCount* count = nullptr);

/// Returns the directories of shipped data (vehicles/, terrain/, scenarios/) in the order of
/// search: $NAVVY_DATA_DIR, the installation, the source tree.
std::vector<std::string> data_directories();
/// Returns the first existing `relative` below data_directories(); empty if there is none.
std::string find_data(const std::string& relative);

}  // namespace navvy::scene_io
