// SPDX-License-Identifier: Apache-2.0
// Message about sampling rates whose period is not a whole number of base steps.
#pragma once

#include <string>

#include "sim/world.h"

namespace navvy::record {

/// Returns a one-line message about all rates that the run cannot meet exactly: a base step that
/// the control rate has shortened, telemetry, particles and cameras that are sampled in the nearest
/// step, and rates above the step rate. Returns an empty text if all rates are exact.
/// `control_rate` is the rate of an external controller [1/s], `particle_rate` that of recorded
/// particles; 0 if there is none.
std::string rates_note(const sim::World& world, double control_rate, double particle_rate = 0);

}  // namespace navvy::record
