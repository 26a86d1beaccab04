// SPDX-License-Identifier: Apache-2.0
// The spline that surfaces of awake soil are smoothed with.
#pragma once

#include <cmath>

namespace navvy::soil {

/// Quadratic B-spline of the cell, support 1.5 cells [Steffen, Kirby & Berzins 2008].
inline double spline(double t) {
  t = std::abs(t);
  return t < 0.5 ? 0.75 - t * t : t < 1.5 ? 0.5 * (1.5 - t) * (1.5 - t) : 0.0;
}

/// Its mean over the particles of a column `d` columns away: a column weighs as the 2 x 2 particles
/// it would wake to.
inline double column_weight(int d) { return 0.5 * (spline(d - 0.25) + spline(d + 0.25)); }

}  // namespace navvy::soil
