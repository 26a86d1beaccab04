// SPDX-License-Identifier: Apache-2.0
// What a scene's machines do in their first second, asked before a run and without a device.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "vehicle/machine_state.h"

namespace navvy::sim {

/// Errors for every pair of machines with masses whose collision shapes, taken as boxes, reach into
/// each other by more than 2 cm where they start; names both links and tells by how much. `X_WB`
/// holds their base links' poses.
std::vector<Fault> check_overlaps(const scene::Scene& scene, const std::vector<Pose>& X_WB);

/// Errors for every machine with masses of which a wheel's centre, or the middle of a moving link's
/// collision shape, lies more than 2 cm below the surface of `ground` where it starts: it would
/// fall for ever, or be thrown out.
std::vector<Fault> check_buried(const scene::Scene& scene, const std::vector<Pose>& X_WB,
                                const heightfield::Terrain& ground);

/// How each machine stands.
struct StartCheck {
  /// One a machine of the scene; none where one starts in the ground.
  std::vector<vehicle::Stability> standing;
  std::vector<bool> falling;  ///< likewise: it has not reached the ground yet
  /// Overlaps, what starts in the ground, machines that tip.
  std::vector<Fault> faults;
  /// What was found in the ground's map, some lines; empty without a map.
  std::string terrain;
  /// What the design is on the untouched site, a line; empty without one.
  std::string design;
};

/// Lays the ground, puts the machines on it and lets them settle for a second (soil at rest, joints
/// held). A ground that cannot be laid is among the faults. Throws nothing of its own.
StartCheck check_start(const scene::Scene& scene);

}  // namespace navvy::sim
