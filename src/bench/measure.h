// SPDX-License-Identifier: Apache-2.0
// Measurement procedure shared by all benches (warm up, restore, repeat, take minimum and median),
// and measurement of a device's peak rates, to which results are compared.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "bench/row.h"

namespace navvy::device {
class Device;
}

namespace navvy::bench {

/// Measures `work` on a device: runs `restore` then `work` once to warm up, and then `runs` more
/// times with the clock. Returns the times of those runs.
///
/// Only `work` is timed, until everything that it queued on the device has finished. Processor time
/// is measured as well, because it remains meaningful on a busy machine. The result contains best,
/// median and spread rather than a mean, because the number of runs is small.
Timing measure(device::Device& device, const std::function<void()>& restore,
               const std::function<void()>& work, int runs = 5);

/// Measures `work` that runs on the host only, in the same way but without a warm-up run.
Timing measure(int runs, const std::function<void()>& restore, const std::function<void()>& work);

/// Returns the processor time that all threads of this process have used so far [s]. It includes
/// kernels of an OpenCL driver that runs on the CPU.
double processor_seconds();

/// Returns the statistics of a series of runs. `wall`: wall time of each run, in any order [s];
/// `processor`: processor time of each run [s], or empty if it was not measured; the result then
/// contains 0.
/// @throws Error when `wall` is empty.
Timing timing_of(std::vector<double> wall, const std::vector<double>& processor);

/// Returns the shortest total time of the device's kernels in one of `runs` runs of `work` [s],
/// measured by the device's own clock, without launches, copies and host code. `restore` runs
/// before each run. Profiling slows a run down slightly, so `measure` does not use it.
double kernel_seconds(device::Device& device, const std::function<void()>& restore,
                      const std::function<void()>& work, int runs = 3);

/// Returns the memory bandwidth of a plain copy kernel over `bytes` bytes: bytes read plus bytes
/// written per second. It is the upper bound for kernels that mainly move memory.
double copy_bandwidth(device::Device& device, std::size_t bytes = std::size_t{1} << 28);

/// Returns the single-precision operations per second of a kernel that only computes fused
/// multiply-adds in registers. It is the upper bound for kernels that mainly compute.
double fma_peak(device::Device& device);

/// Measures copy_bandwidth and fma_peak of a device.
Peak measure_peak(device::Device& device);

}  // namespace navvy::bench
