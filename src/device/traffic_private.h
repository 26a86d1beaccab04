// SPDX-License-Identifier: Apache-2.0
// Counters behind device/traffic.h; included by src/device/*.cpp only.
#pragma once

#include <atomic>
#include <cstdint>

namespace navvy::device {

/// Counters of all devices of this process. Devices may be used in several threads.
struct TrafficCounters {
  std::atomic<std::uint64_t> launches{0}, waits{0}, read_bytes{0}, written_bytes{0};

  /// Counts a read or map of `bytes` bytes; `wait`: whether it waits for queued work.
  void read(std::uint64_t bytes, bool wait) {
    read_bytes.fetch_add(bytes, std::memory_order_relaxed);
    if (wait) waits.fetch_add(1, std::memory_order_relaxed);
  }
  /// Counts a write of `bytes` bytes.
  void write(std::uint64_t bytes) { written_bytes.fetch_add(bytes, std::memory_order_relaxed); }
  /// Counts a launch.
  void launch() { launches.fetch_add(1, std::memory_order_relaxed); }
};

/// Returns the counters.
TrafficCounters& traffic_counters();

}  // namespace navvy::device
