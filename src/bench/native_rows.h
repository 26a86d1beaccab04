// SPDX-License-Identifier: Apache-2.0
// Soil steps beside a native loop (native/native_soil.h) of the same method, from the same state.
#pragma once

#include <functional>
#include <string>

#include "bench/row.h"

namespace navvy::device {
class Device;
}

namespace navvy::bench {

/// Measures collapsing blocks of 8 k, 64 k and 405 k particles as a native loop, of which each of
/// the device's threads runs a copy, and then as OpenCL steps. Passes the two rows of each size to
/// `take` in this order. `only`: part of the name of the sizes that are measured, such as "64k";
/// empty for all.
/// @throws InputError when no size has such a name, or when the device is no CPU.
void run_native_cases(device::Device& device, const std::string& only,
                      const std::function<void(const Row&)>& take);

/// Speed of the OpenCL steps over that of the native loop; above 1 the steps are faster.
struct NativeRatio {
  /// Ratio of the particle-steps per second of wall time, with as many threads.
  double wall = 0;
  /// Ratio of the particle-steps per second of processor time.
  double processor = 0;
};

/// Returns the ratios of a pair of rows from run_native_cases.
NativeRatio native_ratio(const Row& loop, const Row& steps);

}  // namespace navvy::bench
