// SPDX-License-Identifier: Apache-2.0
// Oriented boxes and the depth to which two of them overlap.
#pragma once

#include <array>

#include "core/math.h"

namespace navvy::geometry {

/// Box in any orientation, centred at the origin of its own frame O with edges along the axes of O.
struct OrientedBox {
  Pose X_WO = Pose::Identity();  ///< pose of the box in W
  Vec3 half = Vec3::Zero();      ///< half of the edge lengths [m]
};

/// Returns the corners of a box in W [m]. Corner i is on the positive side of axis k if bit k of i
/// is set.
std::array<Vec3, 8> corners(const OrientedBox& box);

/// Returns the shortest distance by which one box must be moved so that the boxes only touch [m]:
/// the minimum over the fifteen candidate separating axes. If the result is negative or zero, the
/// boxes do not overlap, and their distance is at least its magnitude.
double penetration(const OrientedBox& a, const OrientedBox& b);

}  // namespace navvy::geometry
