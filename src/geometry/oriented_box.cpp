// SPDX-License-Identifier: Apache-2.0
#include "geometry/oriented_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navvy::geometry {

std::array<Vec3, 8> corners(const OrientedBox& box) {
  std::array<Vec3, 8> out;
  for (unsigned i = 0; i < out.size(); ++i) {
    const Vec3 side((i & 1u) != 0 ? 1 : -1, (i & 2u) != 0 ? 1 : -1, (i & 4u) != 0 ? 1 : -1);
    out[i] = box.X_WO * box.half.cwiseProduct(side);
  }
  return out;
}

double penetration(const OrientedBox& a, const OrientedBox& b) {
  const Vec3 between = b.X_WO.translation() - a.X_WO.translation();
  // Half of the extent of a box along a direction.
  const auto extent = [](const OrientedBox& box, const Vec3& axis) {
    return (box.X_WO.linear().transpose() * axis).cwiseAbs().dot(box.half);
  };
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vec3& direction) {
    // Parallel edges give no axis of their own; the axes of the faces cover them.
    const double length = direction.norm();
    if (length < 1e-6) return;
    const Vec3 axis = direction / length;
    least = std::min(least, extent(a, axis) + extent(b, axis) - std::abs(between.dot(axis)));
  };
  for (int i = 0; i < 3; ++i) {
    look(a.X_WO.linear().col(i));
    look(b.X_WO.linear().col(i));
    for (int j = 0; j < 3; ++j)
      look(Vec3(a.X_WO.linear().col(i)).cross(Vec3(b.X_WO.linear().col(j))));
  }
  return least;
}

}  // namespace navvy::geometry
