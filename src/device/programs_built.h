// SPDX-License-Identifier: Apache-2.0
// Count of the kernel programs that this process has built.
#pragma once

#include <cstdint>

namespace navvy::device {

/// Returns the number of kernel programs that this process has built so far, for all devices. A
/// program that a device takes over from another one of the same drivers is not built again.
std::uint64_t programs_built();

}  // namespace navvy::device
