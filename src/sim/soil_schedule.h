// SPDX-License-Identifier: Apache-2.0
// Name of the schedule of the soil's kernels, for clients of a world.
#pragma once

#include <string>

namespace navvy::device {
class Device;
}

namespace navvy::sim {

/// Returns the name of the schedule that the soil's kernels follow on a device: "lanes" or
/// "groups".
/// @throws InputError if the environment variable NAVVY_SOIL_SCHEDULE names none of them.
std::string soil_schedule(const device::Device& device);

}  // namespace navvy::sim
