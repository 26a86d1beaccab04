// SPDX-License-Identifier: Apache-2.0
// Kernel sources: files of kernels/, embedded by the build.
#pragma once

#include <string>

#include "device/device_error.h"

namespace navvy::device {

/// Returns the text of one kernel file, named relative to kernels/, e.g.
/// "soil/lanes/particle_to_grid.cl". It is read from the folder in the environment variable
/// NAVVY_KERNEL_DIR if that is set, so that a kernel can be edited and run without a build, else
/// from the embedded files.
/// @throws DeviceError if there is no such file.
std::string kernel_source(const std::string& path);

/// Returns `text` of file `path` with every `#include "..."` (relative to kernels/) replaced by
/// that file, each file once, and with `#line` directives so that a build log names the files.
/// `#include <...>` is left in place; shared headers hide it from OpenCL. An include must be alone
/// on its line and outside of conditionals.
/// @throws DeviceError naming file and line of an include that does not exist.
std::string expand_includes(const std::string& path, const std::string& text);

}  // namespace navvy::device
