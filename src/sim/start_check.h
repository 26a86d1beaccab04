// SPDX-License-Identifier: Apache-2.0
// Checks of the machines' first second, before a run and without a device.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "vehicle/machine_state.h"

namespace navvy::sim {

/// Returns an error for every pair of dynamic machines whose collision shapes, taken as boxes,
/// overlap by more than 2 cm at the start. It names both links and the depth. `X_WB` holds the
/// poses of the base links.
std::vector<Fault> check_overlaps(const scene::Scene& scene, const std::vector<Pose>& X_WB);

/// Returns an error for every dynamic machine with a wheel's centre, or the middle of a moving
/// link's collision shape, more than 2 cm below the surface of `ground` at the start: it would fall
/// through or be thrown out.
std::vector<Fault> check_buried(const scene::Scene& scene, const std::vector<Pose>& X_WB,
                                const heightfield::Terrain& ground);

/// Result of check_start.
struct StartCheck {
  /// Stability of each machine of the scene; empty if one starts inside the ground.
  std::vector<vehicle::Stability> standing;
  /// True for each machine that has not reached the ground yet; empty likewise.
  std::vector<bool> falling;
  /// Overlaps, machines inside the ground, machines that tip over.
  std::vector<Fault> faults;
  /// Report on the ground's map, some lines; empty without a map.
  std::string terrain;
  /// Comparison of the design with the untouched site, one line; empty without a design.
  std::string design;
};

/// Builds the ground, places the machines on it and lets them settle for a second (soil at rest,
/// joints held). A ground that cannot be built is reported as a fault; nothing is thrown.
StartCheck check_start(const scene::Scene& scene);

}  // namespace navvy::sim
