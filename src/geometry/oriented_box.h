// SPDX-License-Identifier: Apache-2.0
// Boxes turned in space, and how far two of them reach into each other.
#pragma once

#include "core/math.h"

namespace navvy::geometry {

/// A box about the origin of its own frame O.
struct OrientedBox {
  Pose X_WO = Pose::Identity();
  Vec3 half = Vec3::Zero();  ///< half its edges [m]
};

/// How far the two must be moved apart to touch no more [m]; zero or less: there is a gap of at
/// least minus that. By the fifteen axes on which two boxes can be told apart.
double penetration(const OrientedBox& a, const OrientedBox& b);

}  // namespace navvy::geometry
