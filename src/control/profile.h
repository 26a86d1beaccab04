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

/// Returns a transition from 0 at t <= 0 to 1 at t >= 1 at constant acceleration in the first and
/// the last share `r` (above 0, at most 0.5). Its largest slope is 1 / (1 - r).
inline double ramp(double t, double r) {
  const double c = std::clamp(t, 0.0, 1.0);
  if (c < r) return c * c / (2 * r * (1 - r));
  if (c > 1 - r) return 1 - (1 - c) * (1 - c) / (2 * r * (1 - r));
  return (c - 0.5 * r) / (1 - r);
}

/// Returns the linear interpolation between `a` (at t = 0) and `b` (at t = 1). `t` is not clamped,
/// so other values extrapolate.
inline double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace navvy::control
