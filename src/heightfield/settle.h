// SPDX-License-Identifier: Apache-2.0
// Lets a given surface slide to its angle of repose, once, before a run.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A dense surface, x fastest [m].
struct DenseSurface {
  /// Number of columns along x and y.
  int nx = 0, ny = 0;
  /// Edge of a column [m].
  double cell = 0.1;
  /// Heights of the columns.
  std::vector<double> height;
  /// Height of column (ix, iy); nothing is checked.
  double& at(int ix, int iy) { return height[static_cast<std::size_t>(iy) * nx + ix]; }
  double at(int ix, int iy) const { return height[static_cast<std::size_t>(iy) * nx + ix]; }
};

/// Moves soil downhill between edge neighbours until no drop between them exceeds tan(repose) x
/// cell by more than a fiftieth. `repose` is in radians. Volume is conserved to rounding, and the
/// order is fixed, so that the result repeats bit for bit. The sweeps cover the steep part only.
/// Returns the number of sweeps, or -1 when `most_sweeps` did not suffice.
int settle(DenseSurface& surface, double repose, int most_sweeps = 20000);

}  // namespace navvy::heightfield
