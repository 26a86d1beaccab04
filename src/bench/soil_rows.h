// SPDX-License-Identifier: Apache-2.0
// Benchmarks of the particle soil in the configuration that users run, on any device: used by
// `navvy bench` and by bench/scenes/soil_scenes_bench.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/row.h"

namespace navvy::device {
class Device;
}

namespace navvy::bench {

/// One benchmark case of the particle soil.
struct SoilCase {
  /// Name, with the size after a colon.
  std::string name;
  /// Description for `navvy bench --list`.
  std::string help;
  /// True for a short case, which takes a few seconds on two cores.
  bool quick = false;
  /// Runs the case on a device and returns the result.
  std::function<Row(device::Device&)> run;
};

/// Returns all cases, in the order in which they run: a collapsing block, a load held in a bucket,
/// a bucket in a bed, digs on sites of 0.01 to 1 km2, and blocks with increasing numbers of active
/// particles.
const std::vector<SoilCase>& soil_cases();

/// Runs cases on one device and passes each result to `take` as soon as the case has finished.
/// `only`: runs the cases whose name contains this text, all if empty. `quick`: runs only the short
/// cases.
/// @throws InputError when no case has such a name.
void run_soil_cases(device::Device& device, const std::string& only, bool quick,
                    const std::function<void(const Row&)>& take);

}  // namespace navvy::bench
