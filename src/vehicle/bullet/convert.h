// SPDX-License-Identifier: Apache-2.0
// Conversions between the vector, rotation and pose types of Eigen and Bullet. They keep all
// numbers and axes; no frame is rotated.
#pragma once

#include <LinearMath/btTransform.h>

#include "core/math.h"

namespace navvy::vehicle {

// Debian packages Bullet in single and double precision; headers and library must match.
static_assert(sizeof(btScalar) == sizeof(double), "link bullet-float64");

/// Returns the vector in Bullet's type.
inline btVector3 to_bt(const Vec3& v) { return btVector3(v.x(), v.y(), v.z()); }
/// Returns the vector in Eigen's type.
inline Vec3 to_eigen(const btVector3& v) { return Vec3(v.x(), v.y(), v.z()); }
/// Returns the rotation as a quaternion, normalised as Bullet requires.
inline btQuaternion to_bt(const Mat3& R) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  return btQuaternion(q.x(), q.y(), q.z(), q.w());
}
/// Returns the rotation matrix in Eigen's type.
inline Mat3 to_eigen(const btMatrix3x3& m) {
  Mat3 R;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) R(r, c) = m[r][c];
  return R;
}
/// Returns the pose in Bullet's type, as position and rotation with the same axes.
inline btTransform to_bt(const Pose& X) {
  return btTransform(to_bt(Mat3(X.linear())), to_bt(Vec3(X.translation())));
}

}  // namespace navvy::vehicle
