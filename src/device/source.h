// SPDX-License-Identifier: Apache-2.0
// Kernel sources: files of kernels/, embedded by the build.
#pragma once

#include <string>
#include <vector>

#include "device/device_error.h"

namespace navvy::device {

/// Text of one kernel file, named relative to kernels/, e.g. "soil/lanes/particle_to_grid.cl". Read
/// from the folder in the environment variable NAVVY_KERNEL_DIR when it is set (edit and run), else
/// what the build embedded.
/// @throws DeviceError when there is no such file.
std::string kernel_source(const std::string& path);

/// Paths of all embedded files in alphabetical order. Headers that kernels include are among them.
std::vector<std::string> kernel_paths();

/// `text` of file `path` with every `#include "..."` (relative to kernels/) replaced by that file,
/// each file once, and `#line` so that a build log names our files. `#include <...>` is left alone
/// (shared headers hide it from OpenCL). An include stands alone on its line and outside
/// conditionals.
/// @throws DeviceError naming file and line of an include that is not there.
std::string expand_includes(const std::string& path, const std::string& text);

}  // namespace navvy::device
