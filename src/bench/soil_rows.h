// SPDX-License-Identifier: Apache-2.0
// Benchmark rows of the particle soil as users run it, on any device: `navvy bench` and
// bench/scenes/soil_scenes_bench.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/row.h"

namespace navvy::device {
class Device;
}

namespace navvy::bench {

/// One measured case.
struct SoilCase {
  /// With its size after a colon.
  std::string name;
  /// Description for `navvy bench --list`.
  std::string help;
  /// Takes a few seconds on two cores.
  bool quick = false;
  /// Runs the case on a device.
  std::function<Row(device::Device&)> run;
};

/// Returns all cases, in the order in which they run: a collapsing block, a load held in a bucket,
/// a bucket in a bed, digs on sites of 0.01 to 1 km2, blocks of growing numbers of active
/// particles.
const std::vector<SoilCase>& soil_cases();

/// Runs the cases whose name contains `only` (all when empty; `quick`: the short ones) on one
/// device and passes each row to `take` at once.
/// @throws InputError when no name fits.
void run_soil_cases(device::Device& device, const std::string& only, bool quick,
                    const std::function<void(const Row&)>& take);

}  // namespace navvy::bench
