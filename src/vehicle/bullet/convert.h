// SPDX-License-Identifier: Apache-2.0
// Conversions between Eigen and Bullet.
#pragma once

#include <LinearMath/btTransform.h>

#include "core/math.h"

namespace navvy::vehicle {

// Debian has Bullet in both widths; headers and library must use the same.
static_assert(sizeof(btScalar) == sizeof(double), "link bullet-float64");

// The same numbers in the same axes: no frame is rotated here.
inline btVector3 to_bt(const Vec3& v) { return btVector3(v.x(), v.y(), v.z()); }
inline Vec3 to_eigen(const btVector3& v) { return Vec3(v.x(), v.y(), v.z()); }
/// Returns the normalised quaternion of a rotation; Bullet relies on the normalisation.
inline btQuaternion to_bt(const Mat3& R) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  return btQuaternion(q.x(), q.y(), q.z(), q.w());
}
inline Mat3 to_eigen(const btMatrix3x3& m) {
  Mat3 R;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) R(r, c) = m[r][c];
  return R;
}
/// Returns a pose as position and rotation; Bullet's basis has the same columns.
inline btTransform to_bt(const Pose& X) {
  return btTransform(to_bt(Mat3(X.linear())), to_bt(Vec3(X.translation())));
}

}  // namespace navvy::vehicle
