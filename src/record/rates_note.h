// SPDX-License-Identifier: Apache-2.0
// Message about rates that the base step of a run does not divide.
#pragma once

#include <string>

#include "sim/world.h"

namespace navvy::record {

/// Returns a line about all rates that differ from the request: a base step that the control rate
/// made shorter, telemetry and cameras that use the nearest step, and rates above the step rate.
/// Empty if all rates are as requested. `control_rate` [1/s] is that of a controller outside; 0
/// means none.
std::string rates_note(const sim::World& world, double control_rate);

}  // namespace navvy::record
