// SPDX-License-Identifier: Apache-2.0
// Lets a surface slide to its angle of repose once, before a run.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A surface with a stored height for every column of a site.
struct DenseSurface {
  /// Number of columns along x (nx) and along y (ny).
  int nx = 0, ny = 0;
  /// Edge length of a column [m].
  double cell = 0.1;
  /// Height of each column [m], x fastest.
  std::vector<double> height;
  /// Returns a reference to the height of column (ix, iy) [m]. The indices are not checked.
  double& at(int ix, int iy) { return height[static_cast<std::size_t>(iy) * nx + ix]; }
  /// Returns the height of column (ix, iy) [m]. The indices are not checked.
  double at(int ix, int iy) const { return height[static_cast<std::size_t>(iy) * nx + ix]; }
};

/// Moves soil downhill between columns that share an edge, until no height difference between them
/// exceeds tan(repose) * cell by more than 2 %. Only the steep parts of the surface are visited.
/// Volume is conserved up to rounding, and equal input gives a bit-identical result.
/// @param repose angle of repose [rad]
/// @param most_sweeps maximum number of passes over the surface
/// @returns the number of passes that moved soil, or -1 if `most_sweeps` passes were not enough
int settle(DenseSurface& surface, double repose, int most_sweeps = 20000);

}  // namespace navvy::heightfield
