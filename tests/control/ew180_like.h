// SPDX-License-Identifier: Apache-2.0
// A wheeled excavator with the dimensions of vehicles/ew180, built in C++: control is tested
// without the loader.
#pragma once

#include "scene/machine.h"

namespace navvy::control::testing {

/// Chassis, upper structure, boom, stick, bucket; joints swing_joint, boom_joint, arm_joint,
/// bucket_joint in that order; drive without modelled wheels.
scene::Machine ew180_like();

}  // namespace navvy::control::testing
