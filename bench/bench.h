// SPDX-License-Identifier: Apache-2.0
// What every bench does alike: warm up, restore, repeat, take the minimum and the spread, print one row of CSV.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "device/device.h"

namespace navvy::bench {

struct Timing {
  double best = 0;    ///< [s]
  double spread = 0;  ///< (slowest - best) / best
  int runs = 0;
};

/// Runs `restore` then `work` once to warm up and `runs` times for the clock; only `work` is timed, up to the end of
/// what it queued on the device.
Timing measure(device::Device& device, const std::function<void()>& restore, const std::function<void()>& work,
               int runs = 5);

/// Bytes read plus written per second by a plain copy kernel over `bytes` of memory: what a schedule's traffic is held
/// against.
double copy_bandwidth(device::Device& device, std::size_t bytes = std::size_t{1} << 28);

/// One result. Zero in a column that does not apply prints as an empty field.
struct Row {
  std::string bench;
  std::uint64_t particles = 0;  ///< or elements
  std::uint64_t steps = 0;
  Timing timing;
  double bytes_per_particle = 0;  ///< traffic of one step, counted from the kernel's arguments
  double simulated = 0;           ///< simulated time [s], for the real-time factor
  std::string hash;               ///< of the result, compared with the test's before printing
};

/// Prints the row to stdout, the first time under its header. `bandwidth` from `copy_bandwidth`, 0 when not measured.
void print(const device::DeviceInfo& device, const Row& row, double bandwidth = 0);

}  // namespace navvy::bench
