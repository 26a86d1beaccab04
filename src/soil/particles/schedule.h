// SPDX-License-Identifier: Apache-2.0
// Choice of kernels for a device: law, transfers and contact are written for two kinds of hardware.
#pragma once

#include <string>

#include "device/device.h"

namespace navvy::soil {

/// Kind of kernels.
enum class Schedule {
  /// One work-item per block, sixteen lanes at a time: processors (kernels/soil/lanes).
  kLanes,
  /// One work-group per block, a particle, cell or node per work-item: GPUs (kernels/soil/groups).
  kGroups,
};

/// Returns the schedule that the environment variable NAVVY_SOIL_SCHEDULE names (lanes or groups);
/// without it, groups on GPUs and lanes elsewhere.
/// @throws InputError for any other word.
Schedule schedule_for(const device::Device& device);

/// Returns the path of a stage's kernels in the device's schedule, e.g. "soil/groups/rebin.cl" for
/// "rebin".
std::string kernel_path(const device::Device& device, const std::string& stage);

}  // namespace navvy::soil
