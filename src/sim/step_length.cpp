// SPDX-License-Identifier: Apache-2.0
#include "sim/step_length.h"

#include "sim/timing.h"
#include "soil/time_step.h"

namespace navvy::sim {
namespace {

constexpr double kToolSpeed = 2.0;  // [m/s] fastest tip for which the base step must be stable

}  // namespace

// Waves in the stiffest soil and the fastest tool limit the base step.
double longest_step(const scene::Scene& scene) {
  return soil::step_limit(scene.solver, scene.solver.cell, soil::fastest_sound(scene.soils),
                          kToolSpeed);
}

double starting_step(const scene::Scene& scene) {
  const double rate = scene.solver.control_rate;
  return base_step(longest_step(scene), rate > 0 ? 1 / rate : 0);
}

}  // namespace navvy::sim
