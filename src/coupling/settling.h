// SPDX-License-Identifier: Apache-2.0
// Machines put on the ground and left to themselves, without soil that moves: for those who look
// before a run.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "vehicle/machine_state.h"

namespace navvy::coupling {

/// How a machine stands after a while, and how fast it falls.
struct Settled {
  vehicle::Stability stability;
  double fall_speed = 0;  ///< of the base link, downwards [m/s]
};

/// Puts the scene's machines on `ground` as a run does and lets engine, tyres and ruts work for
/// `time` [s]; joints hold, drives brake as they do without a command. Presses ruts into `ground`.
/// No particle wakes, so no device is needed. How each machine of the scene stands then; a
/// kinematic one as it was made, free to nothing. Costs some 0.2 s a machine and second.
std::vector<Settled> settle(const scene::Scene& scene, heightfield::Ground& ground, double time);

}  // namespace navvy::coupling
