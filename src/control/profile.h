// SPDX-License-Identifier: Apache-2.0
// Smooth ways from one value to another.
#pragma once

#include <algorithm>

namespace navvy::control {

/// 0 to 1 over t from 0 to 1, level at both ends; constant beyond them.
inline double smooth(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

/// a at t = 0, b at t = 1; `t` is not clamped.
inline double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace navvy::control
