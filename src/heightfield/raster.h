// SPDX-License-Identifier: Apache-2.0
// Heights of a map at its own resolution, from which columns are interpolated when they are needed.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A map in the simulator's orientation: cell (0, 0) has least x and least y, x fastest. NaN marks
/// a gap.
///
/// Between cell centres heights are bilinear: nothing overshoots and no slope of the finer soil
/// grid exceeds the steepest one between two cells of the map.
struct HeightRaster {
  int nx = 0, ny = 0;
  double cell_x = 1, cell_y = 1;  ///< [m]
  double x0 = 0, y0 = 0;          ///< centre of cell (0, 0) [m]
  std::vector<float> z;           ///< [m]

  float at(int ix, int iy) const { return z[static_cast<std::size_t>(iy) * nx + ix]; }
  float& at(int ix, int iy) { return z[static_cast<std::size_t>(iy) * nx + ix]; }
  /// Bilinear height [m]; outside the outermost centres the nearest value.
  double sample(double x, double y) const;
  /// Mean over a square of `edge` [m] round (x, y): one sample where the map is coarser than that.
  double mean(double x, double y, double edge) const;
};

struct GapFill {
  std::int64_t gaps = 0;  ///< cells that were NaN
  int farthest = 0;       ///< how many cells the farthest one was from a measured one
};
/// Fills every NaN from its neighbours, ring by ring inward: a cell gets the mean of the known
/// among its eight, nearer ones counting more. A map of gaps only stays as it is.
GapFill fill_gaps(HeightRaster& raster);

struct SlopeRange {
  double least = 0, median = 0, most = 0;  ///< [rad]
  double share_above = 0;                  ///< of the places steeper than the limit, 0..1
};
/// Slopes between neighbouring cell centres, from the mean gradient of each 2 x 2 square. No gaps
/// allowed.
SlopeRange slopes(const HeightRaster& raster, double limit);

}  // namespace navvy::heightfield
