// SPDX-License-Identifier: Apache-2.0
// Depth of the loose soil that rests on the columns, computed from its particles.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// Largest gap between a particle and the soil surface below it at which the particle still counts
/// as resting on that surface, in cell edges [docs/exchange.md, maps].
inline constexpr double kLooseGap = 2.0;

/// A soil particle with the data that the heightfield needs. The owner of the particles fills it
/// in.
struct LooseGrain {
  /// Column that contains the particle. Particles outside the site are ignored.
  int ix = 0, iy = 0;
  /// World z of the particle [m].
  double z = 0;
  /// Volume of the particle including pores [m3].
  double volume = 0;
  /// Index of the particle's soil in the site's list of soils.
  std::uint16_t soil = 0;
  /// Volume of the particle divided by its bank volume [-].
  float specific_volume = 1;
  /// Mass of the particle, for sums over the resting soil [kMassQuantum].
  std::int64_t mass = 0;
};

/// The loose soil that rests on each column, computed from particles.
///
/// The particles of a column are stacked in order of height. Each one raises the surface of its
/// column by its volume divided by the column's area. A particle more than kLooseGap cells above
/// that surface counts as being in the air or in a bucket, and is left out. Only columns with
/// resting particles are stored.
class LooseSoil {
 public:
  /// The loose soil that rests on one column.
  struct Column {
    /// Indices of the terrain column along x and y.
    int ix, iy;
    /// World z of the surface of the loose soil [m].
    double top;
    /// Depth of the loose soil above the resting soil of the column [m]; greater than 0.
    double depth;
    /// Soil of the uppermost resting particle, as an index into the site's list of soils.
    std::uint16_t soil;
    /// Volume divided by bank volume of the uppermost resting particle [-].
    float specific_volume;
  };
  /// Makes a site without loose soil.
  LooseSoil() = default;
  /// Stacks `grains` on the resting `columns`. Takes the time of sorting the grains. Equal grains
  /// in equal order give a bit-identical result.
  LooseSoil(const Terrain& columns, std::vector<LooseGrain> grains);
  /// Returns the columns with loose soil, in ascending order of iy, then ix.
  const std::vector<Column>& columns() const { return columns_; }
  /// Returns all resting particles, in the order of `columns()`, and from bottom to top within each
  /// column.
  const std::vector<LooseGrain>& grains() const { return grains_; }

 private:
  /// Columns with loose soil, in ascending order of iy, then ix.
  std::vector<Column> columns_;
  /// Resting particles, in the order of `columns_`, and from bottom to top within each column.
  std::vector<LooseGrain> grains_;
};

}  // namespace navvy::heightfield
