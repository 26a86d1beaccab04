// SPDX-License-Identifier: Apache-2.0
// What every bench does alike: warm up, restore, repeat, take the minimum and the median; and what
// a device can do at most, which the results are held against.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "bench/row.h"

namespace navvy::device {
class Device;
}

namespace navvy::bench {

/// Runs `restore` then `work` once to warm up and `runs` times for the clock; only `work` is timed,
/// up to the end of what it queued on the device. Processor time is counted too: it tells on a busy
/// machine. The number of runs is small, so best, median and spread are kept, not a mean.
Timing measure(device::Device& device, const std::function<void()>& restore,
               const std::function<void()>& work, int runs = 5);

/// The same for work of the host, without a run to warm up.
Timing measure(int runs, const std::function<void()>& restore, const std::function<void()>& work);

/// Processor time of all threads of this process [s]: in a CPU's driver the kernels are among them.
double processor_seconds();

/// Best, median and spread of runs that took so long each, in any order, and the least of their
/// processor times (0 where none was taken) [s]. @throws Error without a run.
Timing timing_of(std::vector<double> wall, const std::vector<double>& processor);

/// Least time that the device's kernels take in one of `runs` runs of `work`, added up by its own
/// clock: no launches, no copies, no host [s]. The clock slows a run down a little, so it is never
/// on in `measure`.
double kernel_seconds(device::Device& device, const std::function<void()>& restore,
                      const std::function<void()>& work, int runs = 3);

/// Bytes read plus written per second by a plain copy kernel over `bytes` of memory: what a
/// schedule's traffic is held against.
double copy_bandwidth(device::Device& device, std::size_t bytes = std::size_t{1} << 28);

/// Single-precision operations per second of a kernel that does nothing but fused multiply-adds in
/// registers. It bounds schedules that compute rather than move memory.
double fma_peak(device::Device& device);

/// Both.
Peak measure_peak(device::Device& device);

}  // namespace navvy::bench
