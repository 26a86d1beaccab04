// SPDX-License-Identifier: Apache-2.0
// Oriented boxes and their penetration.
#pragma once

#include "core/math.h"

namespace navvy::geometry {

/// Box centred at the origin of its own frame O.
struct OrientedBox {
  /// Pose in W.
  Pose X_WO = Pose::Identity();
  /// Half of the edge lengths [m].
  Vec3 half = Vec3::Zero();
};

/// Returns the distance by which the boxes must be separated to touch no more [m], the least over
/// the fifteen separating axes. Zero or negative: the boxes are apart by at least its magnitude.
double penetration(const OrientedBox& a, const OrientedBox& b);

}  // namespace navvy::geometry
