// SPDX-License-Identifier: Apache-2.0
// Which kernels a device runs: the same law, transfers and contact are written for two kinds of
// machine.
#pragma once

#include <string>

#include "device/device.h"

namespace navvy::soil {

enum class Schedule {
  kLanes,  ///< a work-item per block, sixteen lanes at a time: processors (kernels/soil/lanes)
  /// A work-group per block, a particle, cell or node per work-item: GPUs (kernels/soil/groups).
  kGroups,
};

/// What the environment variable NAVVY_SOIL_SCHEDULE says (lanes or groups), else groups on GPUs
/// and lanes elsewhere.
/// @throws InputError for any other word.
Schedule schedule_for(const device::Device& device);

/// Path of a stage's kernels in the device's schedule, e.g. "soil/groups/rebin.cl" for "rebin".
std::string kernel_path(const device::Device& device, const std::string& stage);

}  // namespace navvy::soil
