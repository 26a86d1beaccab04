// SPDX-License-Identifier: Apache-2.0
// Directions of the pixels of a camera without distortion.
#pragma once

#include <cmath>

#include "core/math.h"

namespace navvy::sensor {

/// Directions of pixels in S: x ahead, rows from top to bottom, columns from left to right.
struct Pixels {
  int width, height;  ///< number of pixels
  double tangent;     ///< tangent of half the horizontal field of view

  /// Creates the directions of a camera with the horizontal field of view `fov` [rad].
  Pixels(int columns, int rows, double fov)
      : width(columns), height(rows), tangent(std::tan(0.5 * fov)) {}

  /// Returns the vector in S with x = 1 through a point of a picture: (0, 0) is its upper left
  /// corner, and each pixel has an edge of 1.
  Vec3 ray(double column, double row) const {
    const double scale = 2 * tangent / width;
    return {1, (0.5 * width - column) * scale, (0.5 * height - row) * scale};
  }
};

}  // namespace navvy::sensor
