// SPDX-License-Identifier: Apache-2.0
// Reads worlds, machines and soils from SDF 1.9 files with `navvy:` extension elements
// (docs/reference/scene.md lists them all), and worlds and machines of other simulators from SDF
// 1.3 to 1.12 and URDF (docs/import.md). Every reader collects the errors of all files involved
// before it throws; warnings are logged (core/log.h).
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

/// Changes to a scene given on the command line. They are written into the document before it is
/// read, so that the rules for the file also apply to them.
struct Overrides {
  /// Pairs of key and value, such as {"soil[loam].cohesion_pa", "8000"}. A key is
  /// `<object>.<element>` or a longer path. `[name]` or `[1]` selects one of several objects;
  /// without it all of them change. An object below the first level can also be selected by its
  /// name without brackets, as in machine.digger.uri. Objects are the elements of a world, without
  /// "navvy:".
  std::vector<std::pair<std::string, std::string>> set;
  std::optional<std::uint64_t> seed;  ///< seed of the scene
  std::optional<double> duration;     ///< maximum duration of the run [s]
  /// Soil of the site: a name of a shipped soil or a file. It replaces the one soil of the scene.
  std::optional<std::string> soil;
  /// Names of overlays in pictures, separated by blanks.
  std::optional<std::string> show;
  std::optional<bool> render;  ///< true: cameras record images
  /// Path of a heightmap, relative to the working directory; it replaces procedural shapes.
  std::optional<std::string> terrain;
  std::optional<Vec2> at;    ///< centre of the site in the coordinates of the map [m]
  bool at_is_local = false;  ///< true: `at` is relative to the file's lower-left corner
  std::optional<Vec2> size;  ///< extent of the site along x and y [m]
};

/// Splits "KEY=VALUE" at the first '=' into key and value. @throws InputError if there is no '=' or
/// no key before it
std::pair<std::string, std::string> parse_setting(const std::string& text);

/// Reads a scene file and all files that it names. A file with a machine alone, SDF or URDF, gives
/// a scene in which it stands on the ground.
///
/// @param kinds all types of program steps, usually control::step_kinds(); other steps are errors
/// @param overrides changes to the scene
/// @param resolved receives the scene as one text without references, see resolved.h; may be null
/// @throws InputError with all errors, also if the file cannot be read
scene::Scene load_scene(const std::string& file, const scene::StepKinds& kinds,
                        const Overrides& overrides = {}, std::string* resolved = nullptr);
/// Reads a scene from the text of a scene file. `name` is used as file name in messages, and
/// relative paths start from the directory in `name`. `kinds`, `overrides` and `resolved` are as
/// for `load_scene`. @throws InputError with all errors
scene::Scene load_scene_from_string(const std::string& text, const std::string& name,
                                    const scene::StepKinds& kinds, const Overrides& overrides = {},
                                    std::string* resolved = nullptr);

/// Reads a machine from an SDF file that contains one model. @throws InputError with all errors
scene::Machine load_machine(const std::string& file);

/// Reads the soils of all *.sdf files in a directory, in the order of the file names. @throws
/// InputError with all errors
std::vector<scene::Soil> load_soils(const std::string& directory);

/// Numbers of all errors and warnings of a file, including those that are not listed.
struct FaultCount {
  std::size_t errors = 0, warnings = 0;  ///< numbers of errors and of warnings
};

/// Checks a world, machine, soil or materials file and returns all errors and warnings. Without
/// errors, `*world` receives the scene of the file, and for a machine alone the scene in which it
/// stands on the ground, as for `load_scene`; `*machine` then receives the machine, and is reset
/// for a scene. `overrides` apply to the scene. `*count` receives the total numbers of errors and
/// warnings. Each of these three pointers may be null. Throws nothing except std::bad_alloc.
std::vector<Fault> check(const std::string& file, const scene::StepKinds& kinds,
                         std::optional<scene::Scene>* world = nullptr,
                         const Overrides& overrides = {},
                         std::optional<scene::Machine>* machine = nullptr,
                         FaultCount* count = nullptr);

/// Returns the directories with shipped data (vehicles/, terrain/, scenarios/) in search order:
/// $NAVVY_DATA_DIR, the installation, the source tree.
std::vector<std::string> data_directories();
/// Returns the path of the first existing file or directory `relative` in data_directories(); an
/// empty text if there is none.
std::string find_data(const std::string& relative);

}  // namespace navvy::scene_io
