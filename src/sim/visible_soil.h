// SPDX-License-Identifier: Apache-2.0
// The soil of a world as a beam of light meets it: a surface, and lumps above it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "heightfield/terrain_view.h"
#include "sim/world.h"

namespace navvy::sim {

/// A soil particle that is not part of the ground's surface: in the air, or in a bucket or bed. It
/// counts as a ball of the particle's volume.
struct SoilBall {
  Eigen::Vector3f p_O = Eigen::Vector3f::Zero();  ///< centre, relative to VisibleSoil::origin [m]
  float radius = 0;                               ///< radius [m]
};

/// The soil of a world at one instant.
struct VisibleSoil {
  heightfield::TerrainView surface;  ///< columns with the loose soil that rests on them
  Vec3 origin = Vec3::Zero();        ///< point in W that the balls count from [m]
  std::vector<SoilBall> balls;       ///< particles above the surface, in the order of their ids
};

/// Returns the soil of `world` at the present time: each particle is part of the surface or a ball.
/// Costs a pass over all particles.
VisibleSoil visible_soil(const World& world);

}  // namespace navvy::sim
