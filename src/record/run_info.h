// SPDX-License-Identifier: Apache-2.0
// run.json: what made a run's folder, so that the run can be made again.
#pragma once

#include <string>
#include <vector>

namespace navvy::record {

/// Of folders written here; grows when a file changes its meaning.
inline constexpr int kRunFormat = 1;

/// What stands in a folder beside its results. The scene itself is the folder's scene.sdf, with
/// every override and included file written out: `navvy run FOLDER/scene.sdf` repeats the run.
struct RunInfo {
  int format = kRunFormat;
  std::string version;  ///< of Navvy
  /// As typed, the program first; empty when no command line started the run.
  std::vector<std::string> command;
  /// The file that was asked for, for people: scene.sdf is what ran.
  std::string scene;
  std::string device;  ///< OpenCL device it ran on
};

/// Version of this library, "0.1.0".
std::string navvy_version();

/// The file's text: JSON, keys sorted.
std::string run_json(const RunInfo& info);

/// Reads FOLDER/run.json of any format up to kRunFormat. @throws FileError when there is none,
/// InputError when it is no such file or of a later format.
RunInfo read_run_info(const std::string& folder);

}  // namespace navvy::record
