// SPDX-License-Identifier: Apache-2.0
// Exception of the OpenCL layer.
#pragma once

#include <string>

#include "core/error.h"

namespace navvy::device {

/// Exception for a failed OpenCL call, a kernel that could not be built, or a device that was not
/// found. As far as they apply, `what()` contains the call, the symbolic error name, the kernel,
/// the device and the build log, and what the user can do.
class DeviceError : public Error {
 public:
  /// Stores the complete message and the OpenCL error code; 0 if no OpenCL call failed.
  explicit DeviceError(const std::string& text, int code = 0) : Error(text), code_(code) {}
  /// Returns the OpenCL error code; 0 if no OpenCL call failed. Tests use it, and callers that can
  /// continue with less memory.
  int code() const { return code_; }

 private:
  int code_;
};

/// Returns the symbolic name of an OpenCL error code, e.g. "CL_INVALID_KERNEL_ARGS"; for an unknown
/// code (of an extension or a faulty driver) e.g. "CL error -1234".
std::string error_name(int code);

}  // namespace navvy::device
