// SPDX-License-Identifier: Apache-2.0
// Lets a given surface slide to its angle of repose once, before anything else happens.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// A dense surface, x fastest [m].
struct DenseSurface {
  int nx = 0, ny = 0;
  double cell = 0.1;
  std::vector<double> height;
  double& at(int ix, int iy) { return height[static_cast<std::size_t>(iy) * nx + ix]; }
  double at(int ix, int iy) const { return height[static_cast<std::size_t>(iy) * nx + ix]; }
};

/// Moves soil downhill between edge neighbours until no drop between them exceeds tan(repose) x
/// cell by more than a fiftieth. Volume is kept to rounding; the order is fixed, so the result
/// repeats bit for bit. Costs sweeps over the steep part only. Returns the number of sweeps, or -1
/// when `most_sweeps` did not suffice.
int settle(DenseSurface& surface, double repose, int most_sweeps = 20000);

}  // namespace navvy::heightfield
