// SPDX-License-Identifier: Apache-2.0
// Common procedure of all benches: warm up, restore, repeat, take minimum and median; and the peak
// rates of a device, which results are compared with.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "bench/row.h"

namespace navvy::device {
class Device;
}

namespace navvy::bench {

/// Runs `restore` then `work` once to warm up and `runs` times for the clock. Only `work` is timed,
/// up to the end of what it queued on the device. Processor time is counted, too, as it is
/// meaningful on a busy machine. The number of runs is small, so best, median and spread are kept,
/// not a mean.
Timing measure(device::Device& device, const std::function<void()>& restore,
               const std::function<void()>& work, int runs = 5);

/// Does the same for work of the host, without a warm-up.
Timing measure(int runs, const std::function<void()>& restore, const std::function<void()>& work);

/// Returns the processor time of all threads of this process [s], which includes the kernels of a
/// CPU driver.
double processor_seconds();

/// Returns best, median and spread of runs with these wall times, in any order, and the least of
/// their processor times (0 where none was taken) [s].
/// @throws Error without a run.
Timing timing_of(std::vector<double> wall, const std::vector<double>& processor);

/// Returns the least time that the device's kernels take in one of `runs` runs of `work`, summed by
/// its own clock: no launches, no copies, no host [s]. The clock slows a run down a little, so
/// `measure` never uses it.
double kernel_seconds(device::Device& device, const std::function<void()>& restore,
                      const std::function<void()>& work, int runs = 3);

/// Returns bytes read plus written per second by a plain copy kernel over `bytes` of memory, the
/// bound for a schedule's traffic.
double copy_bandwidth(device::Device& device, std::size_t bytes = std::size_t{1} << 28);

/// Returns single-precision operations per second of a kernel that only does fused multiply-adds in
/// registers, the bound for schedules that compute rather than move memory.
double fma_peak(device::Device& device);

/// Measures both.
Peak measure_peak(device::Device& device);

}  // namespace navvy::bench
