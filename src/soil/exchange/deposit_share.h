// SPDX-License-Identifier: Apache-2.0
// Turns particles into layers: one per soil, its mass shared over columns in integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// Sums over the particles of one soil.
struct SoilShare {
  /// Index of the soil in the world.
  std::uint16_t soil = 0;
  /// [kMassQuantum].
  std::int64_t mass = 0;
  /// Mass-weighted sums of density state, plastic shear and height.
  double volume = 0, shear = 0, height = 0;
};

/// Returns one entry per soil of `grains`, entries of the index, ordered by mean height from below.
std::vector<SoilShare> soil_shares(const ColumnIndex& index, std::span<const std::uint32_t> grains);

/// Returns the soil's layer, still without mass. Density state and plastic shear are the mass
/// means, the state limited to `densest` .. swell. `rise`: volume in the density state / volume
/// that the soil has, 1 where nothing is crowded.
heightfield::SoilLayer layer_of(const SoilShare& share, double swell, double densest,
                                double rise = 1);

/// A column and its integer weight when mass is shared.
struct SharedColumn {
  /// Column of the site.
  int ix = 0, iy = 0;
  /// Share of the mass, in any unit.
  std::int64_t weight = 0;
};
/// Adds `mass` as `layer` to the columns in proportion to their weights, none of which is negative
/// and at least one positive. The first of the heaviest takes the few quanta that rounding leaves.
/// Columns that get nothing are not touched.
void share_out(heightfield::Ground& ground, heightfield::SoilLayer layer, std::int64_t mass,
               std::span<const SharedColumn> columns);

}  // namespace navvy::soil
