// SPDX-License-Identifier: Apache-2.0
// The terrain of a world at this instant.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/terrain_view.h"
#include "sim/world.h"

namespace navvy::sim {

/// A copy of the world's terrain that never changes, stamped with its time. Pictures, maps, files,
/// operators and planners read this and name the surface that they mean.
///
/// The columns alone cost what was changed since the last view, microseconds; loose soil costs a
/// pass over the particles.
heightfield::TerrainView terrain_view(const World& world, heightfield::SurfaceKind surface);

/// Where the soil is that is awake [docs/exchange.md, maps]. Masses by soil of the scene
/// [kMassQuantum]; the three of a soil sum up to what the ledger calls particles, to the unit.
struct ActivePlaces {
  heightfield::LooseSoil lying;         ///< on columns: what maps add to them
  std::vector<std::int64_t> lies;       ///< mass of that
  std::vector<std::int64_t> held;       ///< in buckets and beds, where payloads count it
  std::vector<std::int64_t> elsewhere;  ///< in the air, or on a tool above its rim
};
/// Costs a pass over the particles.
ActivePlaces active_places(const World& world);

}  // namespace navvy::sim
