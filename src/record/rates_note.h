// SPDX-License-Identifier: Apache-2.0
// What a run does about rates that its base step does not divide, told before it starts.
#pragma once

#include <string>

#include "sim/world.h"

namespace navvy::record {

/// One line about everything that comes out other than asked: a base step that the control rate
/// made shorter, telemetry and cameras that take the nearest step, rates above the steps' own.
/// Empty when all is as asked. `control_rate` [1/s] is that of a controller outside; 0: there is
/// none.
std::string rates_note(const sim::World& world, double control_rate);

}  // namespace navvy::record
