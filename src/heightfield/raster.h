// SPDX-License-Identifier: Apache-2.0
// Height map at its own resolution, from which column heights are interpolated on demand.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A height map in memory, oriented as the simulator's grids: cell (0, 0) has the smallest x and y,
/// and x runs fastest. NaN marks a gap, which is a cell without a known height.
///
/// Heights between cell centres are interpolated bilinearly. The result does not overshoot, and is
/// never steeper than the steepest slope between two neighbouring cells.
struct HeightRaster {
  /// Number of cells along x (nx) and along y (ny).
  int nx = 0, ny = 0;
  /// Edge lengths of a cell along x and along y [m].
  double cell_x = 1, cell_y = 1;
  /// Coordinates of the centre of cell (0, 0) [m].
  double x0 = 0, y0 = 0;
  /// Height of each cell [m], x fastest, nx * ny values; NaN in gaps.
  std::vector<float> z;

  /// Returns the height of cell (ix, iy) [m], which must exist.
  float at(int ix, int iy) const { return z[static_cast<std::size_t>(iy) * nx + ix]; }
  /// Returns a reference to the height of cell (ix, iy) [m], which must exist.
  float& at(int ix, int iy) { return z[static_cast<std::size_t>(iy) * nx + ix]; }
  /// Returns the height at position (x, y) [m], interpolated bilinearly between cell centres.
  /// Positions beyond the outermost centres get the value at the nearest point between them.
  double sample(double x, double y) const;
  /// Returns the mean height over a square with edge `edge` [m] around (x, y) [m]. It is a single
  /// sample if the map's cells are not smaller than the square.
  double mean(double x, double y, double edge) const;
};

/// Result of filling the gaps of a height map.
struct GapFill {
  /// Number of cells whose heights were unknown.
  std::int64_t gaps = 0;
  /// Largest distance from a gap to the nearest cell with a known height, in cells.
  int farthest = 0;
};
/// Fills the gaps of `raster`, ring by ring from their edges inwards. Each cell gets the mean of
/// those of its eight neighbours that are known by then; diagonal ones have less weight. A map
/// without any known height is not changed.
GapFill fill_gaps(HeightRaster& raster);

/// Distribution of the slopes of a height map.
struct SlopeRange {
  /// Smallest (`least`), median and largest (`most`) slope [rad].
  double least = 0, median = 0, most = 0;
  /// Fraction of the slopes that are steeper than the limit passed to `slopes`, 0 to 1.
  double share_above = 0;
};
/// Computes one slope for each square of four neighbouring cells, from its mean gradient, and
/// returns their distribution. `limit` is the slope [rad] for SlopeRange::share_above. The map must
/// have no gaps. All results are 0 for a map with a single row or column.
SlopeRange slopes(const HeightRaster& raster, double limit);

}  // namespace navvy::heightfield
