// SPDX-License-Identifier: Apache-2.0
// Description of a machine as text.
#pragma once

#include <string>

#include "scene/machine.h"

namespace navvy::scene {

/// Returns a description of a machine for people, with one line per part: mass, links with their
/// masses [kg], joints with their limits, buckets, beds, cylinders, pump, wheels, encoders, levers
/// and drive. Each line is indented by two spaces.
std::string machine_text(const Machine& machine);

}  // namespace navvy::scene
