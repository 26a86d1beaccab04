// SPDX-License-Identifier: Apache-2.0
// Lets machines settle on the ground without moving soil. Used by checks before a run.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "vehicle/machine_state.h"

namespace navvy::coupling {

/// State of one machine after settling.
struct Settled {
  /// Stability of the machine (see vehicle::Stability).
  vehicle::Stability stability;
  /// Downward speed of the base link [m/s]; negative if it moves up.
  double fall_speed = 0;
  /// Largest height of the base link's origin above that at the start, and the height at the end
  /// above it [m].
  double rise = 0, lift = 0;
  /// Angle by which the base link has turned since the start [rad].
  double turn = 0;
  /// True for a machine that forces can move from its place: dynamic and not fixed to the world.
  bool movable = false;
};

/// Simulates machines, tyres and ruts for `time` [s], and returns the state of each machine of the
/// scene at the end, in the order of the scene.
///
/// The machines are placed on `ground` as in a run. Joints hold their positions and drives brake.
/// Ruts are pressed into `ground`, which therefore changes. No soil particles are created, so no
/// OpenCL device is needed. The entry of a kinematic machine has default values, with
/// `Stability::free` false. The cost is about 0.2 s per machine and simulated second.
std::vector<Settled> settle(const scene::Scene& scene, heightfield::Ground& ground, double time);

}  // namespace navvy::coupling
