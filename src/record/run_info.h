// SPDX-License-Identifier: Apache-2.0
// run.json: the version, command, scene, device, kernels and environment that produced a run's
// folder, so that the run can be repeated.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "device/source.h"

namespace navvy::record {

/// Version of the run folder's format. It increases when the meaning of a file changes.
inline constexpr int kRunFormat = 1;

/// Contents of run.json. The scene itself is in the file scene.sdf of the same folder, with all
/// overrides applied and all included files inserted, so `navvy run FOLDER/scene.sdf` repeats the
/// run.
struct RunInfo {
  /// Version of the folder's format.
  int format = kRunFormat;
  /// Version of Navvy that wrote the folder.
  std::string version;
  /// Command line as typed, beginning with the program. Empty if the run was not started from a
  /// command line.
  std::vector<std::string> command;
  /// Path of the scene file that the user named.
  std::string scene;
  /// Name of the OpenCL device that the run used.
  std::string device;
  /// Kernel files that the run used. The hash is empty in folders of versions that did not record
  /// it.
  device::KernelSources kernels;
  /// Schedule of the soil's kernels: "lanes" or "groups".
  std::string schedule;
  /// Environment variables that the run depended on, by name.
  std::map<std::string, std::string> environment;
};

/// Returns the version of this library, such as "0.1.0".
std::string navvy_version();

/// Returns the variables of this process's environment that a run depends on: all that begin with
/// NAVVY_, POCL_ or OCL_ICD_, and the search paths of scenes. POCL_CACHE_DIR, which the program
/// sets itself, is not among them.
std::map<std::string, std::string> deciding_environment();

/// Returns `info` as the text of run.json, with sorted keys.
std::string run_json(const RunInfo& info);

/// Returns the contents of run.json in `folder`. Reads every format version up to kRunFormat.
/// @throws FileError if the file is missing; InputError if it is not such a file or has a later
/// format version.
RunInfo read_run_info(const std::string& folder);

}  // namespace navvy::record
