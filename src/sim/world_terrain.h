// SPDX-License-Identifier: Apache-2.0
// Terrain of a world at one instant.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/terrain_view.h"
#include "sim/world.h"

namespace navvy::sim {

/// Returns an immutable copy of the world's terrain, stamped with its time. Pictures, maps, files,
/// operators and planners read it and name the surface they need.
///
/// The columns alone cost what changed since the last view, microseconds; loose soil costs a pass
/// over the particles.
heightfield::TerrainView terrain_view(const World& world, heightfield::SurfaceKind surface);

/// Active soil by place [docs/exchange.md, maps]. Masses are by soil of the scene [kMassQuantum];
/// the three masses of a soil sum to the ledger's particles exactly.
struct ActivePlaces {
  /// Soil on columns, which maps add to them.
  heightfield::LooseSoil lying;
  /// Its mass.
  std::vector<std::int64_t> resting;
  /// Mass in buckets and beds, which payloads count.
  std::vector<std::int64_t> held;
  /// Mass in the air, or on a tool above its rim.
  std::vector<std::int64_t> elsewhere;
};
/// Sorts the active soil by place. Costs a pass over the particles.
ActivePlaces active_places(const World& world);

}  // namespace navvy::sim
