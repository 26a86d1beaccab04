// SPDX-License-Identifier: Apache-2.0
// Relaxation by pairs: wherever two neighbours differ by more than repose allows, half of the
// excess moves. This is not how soil slides; it finds a nearby surface that the running simulation
// does not move.
#include "heightfield/settle.h"

#include <algorithm>
#include <cmath>

namespace navvy::heightfield {
namespace {

// Moves half of the excess drop of a pair (a, b) from the higher to the lower column.
bool exchange(double& a, double& b, double most, double tolerance) {
  const double drop = a - b;
  const double excess = std::abs(drop) - most;
  if (excess <= tolerance) return false;
  const double moved = std::copysign(excess / 2, drop);
  a -= moved;
  b += moved;
  return true;
}

}  // namespace

int settle(DenseSurface& surface, double repose, int most_sweeps) {
  // Compares heights instead of angles: one comparison per pair.
  const double most = std::tan(repose) * surface.cell, tolerance = 0.02 * most;
  const auto rows = static_cast<std::size_t>(surface.ny);
  // Revisits only rows in or next to which soil moved, between the columns that moved.
  struct Span {
    int x0, x1;
  };
  std::vector<Span> active(rows, Span{0, surface.nx});
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    // Covers the columns whose drops the move has changed: the pair and its neighbours.
    std::vector<Span> next(rows, Span{surface.nx, 0});
    bool moved = false;
    const auto revisit = [&](int ix, int iy) {
      for (int y = std::max(iy - 1, 0); y <= std::min(iy + 1, surface.ny - 1); ++y) {
        next[y].x0 = std::min(next[y].x0, std::max(ix - 1, 0));
        next[y].x1 = std::max(next[y].x1, std::min(ix + 3, surface.nx));
      }
      moved = true;
    };
    // Directions alternate so that nothing drifts to one side.
    for (int n = 0; n < surface.ny; ++n) {
      const int iy = sweep % 2 == 0 ? n : surface.ny - 1 - n;
      for (int m = active[iy].x0; m < active[iy].x1; ++m) {
        const int ix = sweep % 2 == 0 ? m : active[iy].x1 - 1 - (m - active[iy].x0);
        if (ix + 1 < surface.nx &&
            exchange(surface.at(ix, iy), surface.at(ix + 1, iy), most, tolerance))
          revisit(ix, iy);
        if (iy + 1 < surface.ny &&
            exchange(surface.at(ix, iy), surface.at(ix, iy + 1), most, tolerance)) {
          revisit(ix, iy);
          revisit(ix, iy + 1);
        }
      }
    }
    // If no soil moved, further sweeps have no effect.
    if (!moved) return sweep;
    active = std::move(next);
  }
  return -1;
}

}  // namespace navvy::heightfield
