// SPDX-License-Identifier: Apache-2.0
// Length of the soil's time step.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace navvy::soil {

/// Returns the largest sound speed of the soils [m/s], which limits the step.
double fastest_sound(const std::vector<scene::Soil>& soils);

/// Returns the longest step [s] for cells of `cell` [m] that is stable while tools move at up to
/// `tool_speed` [m/s] and sound at `sound` [m/s]; at most the longest step of the settings.
double step_limit(const scene::SolverSettings& settings, double cell, double sound,
                  double tool_speed);

}  // namespace navvy::soil
