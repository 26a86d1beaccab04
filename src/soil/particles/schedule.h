// SPDX-License-Identifier: Apache-2.0
// Choice of the kernel variant for a device: soil law, transfers and contact are written for two
// kinds of hardware.
#pragma once

#include <string>

#include "device/device.h"

namespace navvy::soil {

/// Variant of the kernels: how the work of a step is distributed over the device.
enum class Schedule {
  /// One work-item per block, which computes sixteen particles at a time in vector lanes. For CPUs
  /// (kernels/soil/lanes).
  kLanes,
  /// One work-group per block, with one particle, cell or node per work-item. For GPUs
  /// (kernels/soil/groups).
  kGroups,
};

/// Returns the schedule named by the environment variable NAVVY_SOIL_SCHEDULE ("lanes" or
/// "groups"). If the variable is not set: kGroups for GPUs, kLanes for all other devices.
/// @throws InputError for any other value of the variable.
Schedule schedule_for(const device::Device& device);

/// Returns the path of a stage's kernel source for the device's schedule, for example
/// "soil/groups/rebin.cl" for the stage "rebin".
std::string kernel_path(const device::Device& device, const std::string& stage);

}  // namespace navvy::soil
