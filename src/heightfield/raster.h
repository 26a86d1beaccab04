// SPDX-License-Identifier: Apache-2.0
// Heights of a map at its own resolution, from which columns are interpolated on demand.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A map in the orientation of the simulator: cell (0, 0) has least x and least y, x runs fastest.
/// NaN marks a gap.
///
/// Heights between the centres of cells are bilinear: nothing overshoots, and no slope of the finer
/// soil grid exceeds the steepest slope between two cells of the map.
struct HeightRaster {
  /// Number of cells along x and y.
  int nx = 0, ny = 0;
  /// Edges of a cell [m].
  double cell_x = 1, cell_y = 1;
  /// Centre of cell (0, 0) [m].
  double x0 = 0, y0 = 0;
  /// Heights [m].
  std::vector<float> z;

  /// Height of a cell [m]; the cell must exist.
  float at(int ix, int iy) const { return z[static_cast<std::size_t>(iy) * nx + ix]; }
  float& at(int ix, int iy) { return z[static_cast<std::size_t>(iy) * nx + ix]; }
  /// Returns the bilinear height [m]; outside the outermost centres the nearest value.
  double sample(double x, double y) const;
  /// Returns the mean over a square of `edge` [m] around (x, y): one sample where the map is
  /// coarser than that.
  double mean(double x, double y, double edge) const;
};

/// Result of filling gaps.
struct GapFill {
  /// Number of cells that were NaN.
  std::int64_t gaps = 0;
  /// Largest distance from such a cell to a known one, in cells.
  int farthest = 0;
};
/// Fills every NaN from its neighbours, ring by ring inward. A cell gets the mean of the known ones
/// among its eight neighbours; nearer ones count more. A map without any height stays as it is.
GapFill fill_gaps(HeightRaster& raster);

/// Distribution of the slopes of a map.
struct SlopeRange {
  /// Smallest, median and largest slope [rad].
  double least = 0, median = 0, most = 0;
  /// Share of the places that are steeper than the limit, 0 to 1.
  double share_above = 0;
};
/// Computes the slopes between neighbouring centres from the mean gradient of each square of 2 x 2
/// cells. The map must have no gaps.
SlopeRange slopes(const HeightRaster& raster, double limit);

}  // namespace navvy::heightfield
