// SPDX-License-Identifier: Apache-2.0
// Kernel sources: files of kernels/, embedded by the build.
#pragma once

#include <string>
#include <vector>

#include "device/device_error.h"

namespace navvy::device {

/// Returns the text of a kernel file, whose path is relative to kernels/, e.g.
/// "soil/lanes/particle_to_grid.cl". If the environment variable NAVVY_KERNEL_DIR is set, the file
/// is read from that folder, so that an edited kernel runs without a build; otherwise the embedded
/// file is returned.
/// @throws DeviceError if there is no such file
std::string kernel_source(const std::string& path);

/// Returns `text`, the content of the kernel file `path`, with every `#include "..."` (relative to
/// kernels/) replaced by the content of that file, at its first occurrence only. `#line` directives
/// make the build log refer to the original files. `#include <...>` is left unchanged; shared
/// headers hide it from OpenCL. An include must be the only text on its line and outside
/// conditionals.
/// @throws DeviceError naming file and line of an include that does not exist
std::string expand_includes(const std::string& path, const std::string& text);

/// Returns the build log `log` with each `<kernel>:LINE` replaced by `file:line`. `source` is the
/// expanded text; NVIDIA's compiler ignores its `#line`.
std::string with_files(const std::string& log, const std::string& source);

/// The kernel files as a whole, as programs are built from them at the moment.
struct KernelSources {
  /// Hash of the paths and contents of all files.
  std::string hash;
  /// Folder that replaces the embedded files (NAVVY_KERNEL_DIR); empty if none does.
  std::string folder;
  /// Paths of the files that differ from the embedded ones, or that the folder lacks.
  std::vector<std::string> changed;
};

/// Returns hash and origin of the kernel files. Reads all of them if a folder replaces the embedded
/// ones.
KernelSources kernel_sources();

}  // namespace navvy::device
