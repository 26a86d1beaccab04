// SPDX-License-Identifier: Apache-2.0
// Turns particles into layers: one layer per soil, whose mass is divided over columns in integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// Sums over the particles of one soil within a set of particles.
struct SoilShare {
  /// Index of the soil in the world's list.
  std::uint16_t soil = 0;
  /// Total mass [kMassQuantum].
  std::int64_t mass = 0;
  /// Sums of mass x density state J0 (`volume`), mass x plastic shear (`shear`) and mass x height
  /// above datum in cells (`height`), with masses in kMassQuantum.
  double volume = 0, shear = 0, height = 0;
};

/// Returns the sums over the particles `grains` (indices into `index`), one entry per soil, ordered
/// by mean height from bottom to top.
std::vector<SoilShare> soil_shares(const ColumnIndex& index, std::span<const std::uint32_t> grains);

/// Returns the layer of a soil; its mass is still zero. Volume ratio and plastic shear are the
/// mass-weighted means, the volume ratio limited to `densest` .. `swell`. `rise`: volume that the
/// soil needs in its density state, divided by the volume that it occupies; above 1 where particles
/// are crowded, and the layer is then made denser.
heightfield::SoilLayer layer_of(const SoilShare& share, double swell, double densest,
                                double rise = 1);

/// A column that receives a share of a mass.
struct SharedColumn {
  /// Indices of the column, from the site's lower-left corner.
  int ix = 0, iy = 0;
  /// Share of the mass, relative to the sum of all weights.
  std::int64_t weight = 0;
};
/// Distributes `mass` [kMassQuantum] of soil, with the properties of `layer`, over `columns` in
/// proportion to their weights. No weight may be negative, and at least one must be positive. The
/// column of the largest weight receives the remainder of the integer division (the first one if
/// several are equal). Columns whose share is zero are not changed.
void share_out(heightfield::Ground& ground, heightfield::SoilLayer layer, std::int64_t mass,
               std::span<const SharedColumn> columns);

}  // namespace navvy::soil
