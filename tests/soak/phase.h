// SPDX-License-Identifier: Apache-2.0
// What a soak notes once a cycle, always at the same phase of it, and the table it keeps of that.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace navvy::soak {

/// Bytes that this process holds.
struct Bytes {
  /// Given out by malloc, all arenas; what a thread keeps ready counts as given out.
  std::int64_t heap = 0;
  std::int64_t resident = 0;  ///< of the process, in memory
  std::int64_t device = 0;    ///< of buffers on the device
};

/// Asks the C library and the system. `device`: as device::Device::memory_used says.
Bytes bytes_in_use(std::uint64_t device);

/// How things stood at the end of a cycle.
struct Phase {
  long cycle = 0;   ///< how many are done
  double time = 0;  ///< simulated [s]
  double wall = 0;  ///< since its process began [s]
  int process = 0;  ///< which of those that took turns, from 1
  Bytes bytes;
  int particles = 0;        ///< awake
  std::int64_t ledger = 0;  ///< error of the mass ledger [kMassQuantum]
  std::string hash;         ///< of the state
};

/// Rows of phases.csv, whole ones only; none when there is no such file. @throws FileError,
/// InputError.
std::vector<Phase> read_phases(const std::string& path);
/// Replaces the table by these rows, whole.
void write_phases(const std::string& path, const std::vector<Phase>& phases);
/// Adds a row. The rows stay in the file alone: kept in memory they would be the growth that is
/// looked for.
void append_phase(const std::string& path, const Phase& phase);

}  // namespace navvy::soak
