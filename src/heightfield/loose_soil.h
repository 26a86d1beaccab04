// SPDX-License-Identifier: Apache-2.0
// Loose soil on resting columns, computed from its particles.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// A particle this far above the surface reached so far is separated from it by a gap [cells]
/// [docs/exchange.md, maps].
inline constexpr double kLooseGap = 2.0;

/// A particle as the heightfield sees it. The owner of the particles fills it in.
struct LooseGrain {
  /// Column below the particle; grains off the site are left out.
  int ix = 0, iy = 0;
  /// Height in W [m].
  double z = 0;
  /// Volume including pores [m3].
  double volume = 0;
  /// Index into the soils of the site.
  std::uint16_t soil = 0;
  /// Volume over bank volume.
  float specific_volume = 1;
  /// Mass, for accounts of the resting soil [kMassQuantum].
  std::int64_t mass = 0;
};

/// The surface of loose soil, column by column.
///
/// Grains are stacked on their column from the lowest up; each raises the surface by its volume
/// over the area of the column. A grain more than two cells above the surface reached so far is in
/// the air or in a bucket: neither it nor the grains above it rest on the column, until the gap is
/// closed. Only columns with resting grains are held.
class LooseSoil {
 public:
  /// The loose soil on one column.
  struct Column {
    int ix, iy;
    /// Height of its surface in W [m].
    double top;
    /// Depth above the resting column [m]; positive.
    double depth;
    /// Soil of the uppermost resting grain.
    std::uint16_t soil;
    /// Volume over bank volume of the same grain.
    float specific_volume;
  };
  /// Makes a site without loose soil.
  LooseSoil() = default;
  /// Stacks the grains on the columns; costs a sort of the grains. The same grains in the same
  /// order give a bit-identical result.
  LooseSoil(const Terrain& columns, std::vector<LooseGrain> grains);
  /// Returns the columns row by row, each row from least x.
  const std::vector<Column>& columns() const { return columns_; }
  /// Returns the resting grains in the order of the columns, each column from below.
  const std::vector<LooseGrain>& grains() const { return grains_; }

 private:
  std::vector<Column> columns_;
  std::vector<LooseGrain> grains_;
};

}  // namespace navvy::heightfield
