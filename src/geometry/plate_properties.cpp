// SPDX-License-Identifier: Apache-2.0
#include "geometry/plate_properties.h"

namespace navvy::geometry {

SolidProperties plate_properties(const TriangleMesh& mesh, double thickness) {
  SolidProperties out;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 area = 0.5 * mesh.area_vector(t);
    const double volume = thickness * area.norm();
    if (!(volume > 0)) continue;
    const Vec3 sum = mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2);
    Mat3 squares = sum * sum.transpose();
    for (std::size_t i = 0; i < 3; ++i)
      squares += mesh.corner(t, i) * mesh.corner(t, i).transpose();
    const Vec3 normal = area.normalized();
    out.volume += volume;
    first += volume / 3 * sum;
    // The integral of p p^T over a triangle is area / 12 times `squares`; the thickness adds that
    // of a line along the normal.
    second += volume / 12 * (squares + thickness * thickness * normal * normal.transpose());
  }
  if (!(out.volume > 0)) return out;
  out.p_BCom = first / out.volume;
  second -= out.volume * out.p_BCom * out.p_BCom.transpose();
  out.inertia = second.trace() * Mat3::Identity() - second;
  return out;
}

}  // namespace navvy::geometry
