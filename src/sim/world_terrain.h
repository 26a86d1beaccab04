// SPDX-License-Identifier: Apache-2.0
// The terrain of a world and the distribution of its active soil, both at one instant.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/terrain_view.h"
#include "sim/world.h"

namespace navvy::sim {

/// Returns an immutable copy of the world's terrain at the current simulated time. `surface`
/// selects the surface that heights refer to: the columns only, or the columns with loose soil on
/// them.
///
/// The surface for maps (SurfaceKind::kMapped) also holds the areas that all bodies occupy.
///
/// A view of the columns only costs microseconds, depending on what has changed since the last
/// view. A view with loose soil costs a pass over all particles.
heightfield::TerrainView terrain_view(const World& world, heightfield::SurfaceKind surface);
/// Returns the surface for maps without the areas that bodies occupy, which readers of heights do
/// not need.
heightfield::TerrainView mapped_surface(const World& world);

/// Distribution of the active soil between ground, tools and air [docs/exchange.md, maps]. Each
/// mass list has one entry per soil of the scene, in units of kMassQuantum. The three masses of a
/// soil sum exactly to its mass in MassLedger::particles.
struct ActivePlaces {
  /// Active soil that rests on ground columns, directly or on other soil. Maps add it to the height
  /// of the columns.
  heightfield::LooseSoil on_ground;
  /// Mass of the active soil that rests on ground columns, per soil of the scene [kMassQuantum].
  std::vector<std::int64_t> resting;
  /// Mass of the soil in buckets and beds, per soil of the scene [kMassQuantum]; payloads contain
  /// it.
  std::vector<std::int64_t> held;
  /// Mass of the soil in the air or on a tool above its rim, per soil of the scene [kMassQuantum].
  std::vector<std::int64_t> elsewhere;
};
/// Returns the distribution of the world's active soil between ground, tools and air. Costs a pass
/// over all particles.
ActivePlaces active_places(const World& world);

}  // namespace navvy::sim
