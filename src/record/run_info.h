// SPDX-License-Identifier: Apache-2.0
// run.json: what made a run's folder, so that the run can be made again.
#pragma once

#include <string>
#include <vector>

namespace navvy::record {

/// Format of run folders. It grows when the meaning of a file changes.
inline constexpr int kRunFormat = 1;

/// Description of a run in its folder. The scene itself is scene.sdf, with all overrides and
/// included files written out, so `navvy run FOLDER/scene.sdf` repeats the run.
struct RunInfo {
  /// Format of the folder.
  int format = kRunFormat;
  /// Version of Navvy.
  std::string version;
  /// Command line as typed, the program first. Empty if no command line started the run.
  std::vector<std::string> command;
  /// Scene file that the user named.
  std::string scene;
  /// OpenCL device of the run.
  std::string device;
};

/// Returns the version of this library, e.g. "0.1.0".
std::string navvy_version();

/// Returns the text of run.json, with sorted keys.
std::string run_json(const RunInfo& info);

/// Reads FOLDER/run.json of any format up to kRunFormat. @throws FileError when it is missing,
/// InputError when it is another file or has a later format.
RunInfo read_run_info(const std::string& folder);

}  // namespace navvy::record
