// SPDX-License-Identifier: Apache-2.0
// Counts of what crosses between the host and its devices.
#pragma once

#include <cstdint>

namespace navvy::device {

/// Launches and transfers of all devices of this process since it started. Where host and device
/// share memory, mapped bytes are not copied, but count all the same: they are what another device
/// would copy. Fills and copies on a device do not count.
struct DeviceTraffic {
  std::uint64_t launches = 0;       ///< number of kernel launches
  std::uint64_t waits = 0;          ///< number of reads and maps that waited for queued work
  std::uint64_t read_bytes = 0;     ///< size of what was read or mapped [bytes]
  std::uint64_t written_bytes = 0;  ///< size of what was written, or mapped to be changed [bytes]
};

/// Returns the counts so far. Thread-safe.
DeviceTraffic traffic();

}  // namespace navvy::device
