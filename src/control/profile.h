// SPDX-License-Identifier: Apache-2.0
// Smooth transitions from one value to another.
#pragma once

#include <algorithm>

namespace navvy::control {

/// Returns a smooth transition from 0 at t <= 0 to 1 at t >= 1 (cubic, with zero slope at both
/// ends). `t` is dimensionless.
inline double smooth(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

/// Returns the linear interpolation between `a` (at t = 0) and `b` (at t = 1). `t` is not clamped,
/// so other values extrapolate.
inline double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace navvy::control
