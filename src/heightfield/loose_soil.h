// SPDX-License-Identifier: Apache-2.0
// Loose soil that lies on resting columns, from the particles that it is made of.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// A particle this far above the surface reached so far has a gap under it [cells]
/// [docs/exchange.md, maps].
inline constexpr double kLooseGap = 2.0;

/// A particle as a heightfield sees it. Who owns particles hands them in like this.
struct LooseGrain {
  int ix = 0, iy = 0;         ///< column above which it is; others than the site's are left out
  double z = 0;               ///< W [m]
  double volume = 0;          ///< with its pores [m3]
  std::uint16_t soil = 0;     ///< index into the site's soils
  float specific_volume = 1;  ///< volume / bank volume
  std::int64_t mass = 0;      ///< [kMassQuantum]; for who counts what lies
};

/// The surface of loose soil, column by column.
///
/// Grains are stacked on their column from the lowest up, each raising the surface by its volume
/// over the column's area. A grain more than two cells above the surface reached so far is in the
/// air or in a bucket: it does not lie there, and neither do those above it, until the gap is
/// closed. Holds only columns where something lies.
class LooseSoil {
 public:
  struct Column {
    int ix, iy;
    double top;             ///< surface in W [m]
    double depth;           ///< over the resting column [m], above 0
    std::uint16_t soil;     ///< of the uppermost grain that lies there
    float specific_volume;  ///< of the same
  };
  LooseSoil() = default;
  /// Costs a sort of the grains. The same grains in the same order give the same bits.
  LooseSoil(const Terrain& columns, std::vector<LooseGrain> grains);
  /// Row by row, each row from least x.
  const std::vector<Column>& columns() const { return columns_; }
  /// The grains that lie, column by column like those, each column from below.
  const std::vector<LooseGrain>& grains() const { return grains_; }

 private:
  std::vector<Column> columns_;
  std::vector<LooseGrain> grains_;
};

}  // namespace navvy::heightfield
