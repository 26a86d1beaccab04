// SPDX-License-Identifier: Apache-2.0
// Choices that depend on the device: the kernel variant, as soil law, transfers and contact are
// written for two kinds of hardware, and the number of particles that are worth more threads.
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

/// Returns the number of particles below which kernels run in the caller's thread, where the device
/// has a driver for it: signalling worker threads then costs more than dividing the work saves
/// [docs/soil.md, threads]. The environment variable NAVVY_FEW_PARTICLES replaces the number; with
/// 0 kernels never run in the caller's thread.
/// @throws InputError if the variable is not a number from 0 upwards.
double few_particles(const device::Device& device);

}  // namespace navvy::soil
