// SPDX-License-Identifier: Apache-2.0
// Benchmarks of the particle soil in the configuration that users run, on any device: used by
// `navvy bench`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/row.h"
#include "scene/soil.h"

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
  /// Runs the case with a soil on a device and returns the result.
  std::function<Row(device::Device&, const scene::Soil&)> run;
};

/// Choice of cases and of their soil.
struct SoilChoice {
  /// Part of the name of every case that is run; empty for all.
  std::string only = {};
  /// True for the short cases only.
  bool quick = false;
  /// Soil of all cases, whose name then follows that of a row after "@"; without one it is
  /// bench_sand().
  std::optional<scene::Soil> soil = {};
};

/// Returns all cases, in the order in which they run: a collapsing block, a load held in a bucket,
/// a bucket in a bed, digs on sites of 0.01 to 1 km2, and blocks with increasing numbers of active
/// particles.
const std::vector<SoilCase>& soil_cases();

/// Returns the dry sand of the validation cases, so that a bench measures what the tests check.
scene::Soil bench_sand();

/// Returns the number of particles below which kernels run in the caller's thread on this device
/// (soil::few_particles).
double caller_below(const device::Device& device);

/// Runs cases on one device and passes each result to `take` as soon as the case has finished.
/// @throws InputError when no case has such a name.
void run_soil_cases(device::Device& device, const SoilChoice& choice,
                    const std::function<void(const Row&)>& take);

}  // namespace navvy::bench
