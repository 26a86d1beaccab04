// SPDX-License-Identifier: Apache-2.0
// Rows that measure the particle soil as users run it, on any device: `navvy bench` and
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

/// What a row measures.
struct SoilCase {
  std::string name;  ///< with its size after a colon
  std::string help;
  bool quick = false;  ///< a few seconds on two cores
  std::function<Row(device::Device&)> run;
};

/// Every case, in the order they are run: a collapsing block, a load held in a bucket, a bucket in
/// a bed, digs on sites of 0.01 to 1 km2, blocks of growing numbers of awake particles.
const std::vector<SoilCase>& soil_cases();

/// Runs the cases whose name holds `only` (all when empty; `quick`: the short ones) on one device,
/// hands each row to `take` as soon as it is there. @throws InputError when no name fits.
void run_soil_cases(device::Device& device, const std::string& only, bool quick,
                    const std::function<void(const Row&)>& take);

}  // namespace navvy::bench
