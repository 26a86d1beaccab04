// SPDX-License-Identifier: Apache-2.0
#include "soil/time_step.h"

#include <algorithm>

#include "soil/particles/soil_table.h"

namespace navvy::soil {

double fastest_sound(const std::vector<scene::Soil>& soils) {
  double out = 0;
  for (const scene::Soil& soil : soils) out = std::max(out, sound_speed(soil));
  return out;
}

// Courant's condition; the speed of the fastest tool adds to that of sound
// [docs/soil.md, time step].
double step_limit(const scene::SolverSettings& settings, double cell, double sound,
                  double tool_speed) {
  return std::min(settings.max_step, settings.courant * cell / (sound + tool_speed));
}

}  // namespace navvy::soil
