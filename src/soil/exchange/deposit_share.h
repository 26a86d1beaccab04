// SPDX-License-Identifier: Apache-2.0
// Particles become layers: one a soil, its mass shared out over columns in integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// What one soil of some particles comes to.
struct SoilShare {
  std::uint16_t soil = 0;
  std::int64_t mass = 0;  ///< [kMassQuantum]
  /// Mass-weighted sums of density state, plastic shear and height.
  double volume = 0, shear = 0, height = 0;
};

/// One entry a soil of `grains`, entries of the index, in the order of mean height from below.
std::vector<SoilShare> soil_shares(const ColumnIndex& index, std::span<const std::uint32_t> grains);

/// The soil's layer, still without mass: density state and plastic shear are the mass means, the
/// state within 0.88 .. swell. `rise`: how much its state stands over the room that it has, 1 where
/// nothing is crowded.
heightfield::SoilLayer layer_of(const SoilShare& share, double swell, double rise = 1);

/// A column and its share of what is booked, in whole numbers.
struct SharedColumn {
  int ix = 0, iy = 0;
  std::int64_t weight = 0;
};
/// Puts `mass` as `layer` onto the columns in proportion to their weights, of which one at least is
/// positive and none negative. What rounding leaves, a few quanta, the first of the heaviest takes.
/// Columns that get nothing are not touched.
void share_out(heightfield::Ground& ground, heightfield::SoilLayer layer, std::int64_t mass,
               std::span<const SharedColumn> columns);

}  // namespace navvy::soil
