// SPDX-License-Identifier: Apache-2.0
// Spline that smooths the surface of active soil.
#pragma once

#include <cmath>

namespace navvy::soil {

/// Returns the quadratic B-spline with a knot spacing of one cell at distance `t` from its centre
/// [cells]; it is zero beyond 1.5 cells [Steffen, Kirby & Berzins 2008].
inline double spline(double t) {
  t = std::abs(t);
  return t < 0.5 ? 0.75 - t * t : t < 1.5 ? 0.5 * (1.5 - t) * (1.5 - t) : 0.0;
}

/// Returns the weight of a column that is `d` columns away along one axis: the mean of `spline`
/// over the 2 x 2 particles that the column would become.
inline double column_weight(int d) { return 0.5 * (spline(d - 0.25) + spline(d + 0.25)); }

}  // namespace navvy::soil
