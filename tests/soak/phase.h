// SPDX-License-Identifier: Apache-2.0
// Record of a soak after each cycle, always at the same phase, and the table of these records.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace navvy::soak {

/// Bytes held by this process.
struct Bytes {
  /// Allocated by malloc in all arenas, including memory that a thread caches.
  std::int64_t heap = 0;
  /// Resident memory of the process.
  std::int64_t resident = 0;
  /// Buffers on the device.
  std::int64_t device = 0;
};

/// Queries the C library and the system. `device`: as returned by device::Device::memory_used.
Bytes bytes_in_use(std::uint64_t device);

/// State at the end of a cycle.
struct Phase {
  /// Number of finished cycles.
  long cycle = 0;
  /// Simulated time [s].
  double time = 0;
  /// Wall time since its process began [s].
  double wall = 0;
  /// Number of the process, from 1.
  int process = 0;
  Bytes bytes;
  /// Number of active particles.
  int particles = 0;
  /// Error of the mass ledger [kMassQuantum].
  std::int64_t ledger = 0;
  /// Hash of the state.
  std::string hash;
};

/// Returns the complete rows of phases.csv; none if the file does not exist. @throws FileError,
/// InputError.
std::vector<Phase> read_phases(const std::string& path);
/// Replaces the table by these rows as a whole.
void write_phases(const std::string& path, const std::vector<Phase>& phases);
/// Appends a row. Rows are kept in the file only: in memory they would be the growth that the soak
/// looks for.
void append_phase(const std::string& path, const Phase& phase);

}  // namespace navvy::soak
