// SPDX-License-Identifier: Apache-2.0
// What the OpenCL layer throws.
#pragma once

#include <string>

#include "core/error.h"

namespace navvy::device {

/// An OpenCL call failed, a kernel did not build, or no device matched. `what()` holds the call,
/// the symbolic name of the error, kernel, device and the build log, as far as they apply, and what
/// to do about it.
class DeviceError : public Error {
 public:
  explicit DeviceError(const std::string& text, int code = 0) : Error(text), code_(code) {}
  /// The OpenCL error code; 0 when no call failed (for example no device matched). For tests and
  /// for callers that can go on with less memory; people read `what()`.
  int code() const { return code_; }

 private:
  int code_;
};

/// Symbolic name of an OpenCL error code, e.g. "CL_INVALID_KERNEL_ARGS"; "CL error -1234" for an
/// unknown one. Unknown ones come from extensions and from faulty drivers; the number can then be
/// looked up in the vendor's headers.
std::string error_name(int code);

}  // namespace navvy::device
