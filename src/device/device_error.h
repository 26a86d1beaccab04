// SPDX-License-Identifier: Apache-2.0
// Exception of the OpenCL layer.
#pragma once

#include <string>

#include "core/error.h"

namespace navvy::device {

/// An OpenCL call failed, a kernel did not build, or no device matched. `what()` holds the call,
/// the symbolic name of the error, the kernel, the device and the build log, as far as they apply,
/// and what to do.
class DeviceError : public Error {
 public:
  /// Takes the whole message and the OpenCL error code, or 0 if no call failed.
  explicit DeviceError(const std::string& text, int code = 0) : Error(text), code_(code) {}
  /// Returns the OpenCL error code, or 0 if no call failed. It serves tests and callers that can
  /// continue with less memory.
  int code() const { return code_; }

 private:
  int code_;
};

/// Returns the symbolic name of an OpenCL error code, e.g. "CL_INVALID_KERNEL_ARGS", or "CL error
/// -1234" for an unknown one (from an extension or a faulty driver).
std::string error_name(int code);

}  // namespace navvy::device
