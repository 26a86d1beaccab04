// SPDX-License-Identifier: Apache-2.0
// Spline that smooths surfaces of active soil.
#pragma once

#include <cmath>

namespace navvy::soil {

/// Returns the quadratic B-spline of the cell, support 1.5 cells [Steffen, Kirby & Berzins 2008].
inline double spline(double t) {
  t = std::abs(t);
  return t < 0.5 ? 0.75 - t * t : t < 1.5 ? 0.5 * (1.5 - t) * (1.5 - t) : 0.0;
}

/// Returns its mean over the particles of a column `d` columns away: a column weighs as the 2 x 2
/// particles that it would become.
inline double column_weight(int d) { return 0.5 * (spline(d - 0.25) + spline(d + 0.25)); }

}  // namespace navvy::soil
