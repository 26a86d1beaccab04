// SPDX-License-Identifier: Apache-2.0
// Smooth transitions from one value to another.
#pragma once

#include <algorithm>

namespace navvy::control {

/// Returns the smooth step of t: 0 at t <= 0, 1 at t >= 1, with zero slope at both ends.
inline double smooth(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

/// Interpolates linearly: a at t = 0, b at t = 1; `t` is not clamped.
inline double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace navvy::control
