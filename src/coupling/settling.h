// SPDX-License-Identifier: Apache-2.0
// Settles machines on the ground without moving soil, for checks before a run.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "vehicle/machine_state.h"

namespace navvy::coupling {

/// State of a machine after settling.
struct Settled {
  vehicle::Stability stability;
  /// Speed of the base link, positive downwards [m/s].
  double fall_speed = 0;
};

/// Places the scene's machines on `ground` as a run does, steps physics engine, tyres and ruts for
/// `time` [s], and returns the state of each machine of the scene. Joints hold and drives brake, as
/// they do without a command. Presses ruts into `ground`. No particle becomes active, so no device
/// is needed. A kinematic machine keeps its initial state and is not free. Costs about 0.2 s per
/// machine and simulated second.
std::vector<Settled> settle(const scene::Scene& scene, heightfield::Ground& ground, double time);

}  // namespace navvy::coupling
