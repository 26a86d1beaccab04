// SPDX-License-Identifier: Apache-2.0
// Area that the nodes around a plate stand for, compared with the plate's own.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/memo.h"
#include "soil/host_law/double_contact.h"
#include "soil/tools/contact.h"

namespace navvy::soil {
namespace {

double segment_distance(const Vec3& p, const std::array<Vec3, 2>& s) {
  const Vec3 d = s[1] - s[0];
  const double t = std::clamp((p - s[0]).dot(d) / std::max(d.squaredNorm(), 1e-30), 0.0, 1.0);
  return (p - s[0] - t * d).norm();
}

/// Calls visit(point, area) for the centres of equal parts of a triangle, with sides of at most
/// `longest` (or 1/64 of its own).
template <class Visit>
void sample_triangle(const std::array<Vec3, 3>& corner, double longest, const Visit& visit) {
  const Vec3 u = corner[1] - corner[0], v = corner[2] - corner[0];
  const int n = std::clamp(
      static_cast<int>(std::ceil(std::max({u.norm(), v.norm(), (u - v).norm()}) / longest)), 1, 64);
  const double area = 0.5 * u.cross(v).norm() / (n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      visit(Vec3(corner[0] + ((i + 1 / 3.0) * u + (j + 1 / 3.0) * v) / n), area);
      if (i + j + 1 < n) visit(Vec3(corner[0] + ((i + 2 / 3.0) * u + (j + 2 / 3.0) * v) / n), area);
    }
}

/// Plates a cell or two wide hardly touch soil at all; their area is not scaled up further.
constexpr double kMostAreaFactor = 2;

double compute_area_factor(const ShellGeometry& geometry, double cell,
                           const SchemeConstants& scheme) {
  const reference::Reach r{scheme.contact_reach,
                           scheme.contact_ramp,
                           scheme.contact_edge,
                           scheme.contact_edge_ramp,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0};
  double whole = 0, stood_for = 0;
  for (const ShellGeometry::Triangle& triangle : geometry.triangles())
    sample_triangle(triangle.corner, 0.25 * cell, [&](const Vec3& p, double area) {
      double inset = INFINITY;
      for (const auto& rim : geometry.rims())
        inset = std::min(inset, segment_distance(p, rim) / cell);
      whole += area;
      stood_for += area * reference::contact_inner(std::min(inset, 1e3), &r);
    });
  return std::min(whole / std::max(stood_for, 1e-30), kMostAreaFactor);
}

}  // namespace

double plate_area_factor(const ShellGeometry& geometry, double cell,
                         const SchemeConstants& scheme) {
  // All that the factor follows from; rims are sides of triangles, but of which ones is not.
  std::vector<double> key{cell, scheme.contact_reach, scheme.contact_ramp, scheme.contact_edge,
                          scheme.contact_edge_ramp};
  for (const ShellGeometry::Triangle& triangle : geometry.triangles())
    for (const Vec3& p : triangle.corner) key.insert(key.end(), p.data(), p.data() + 3);
  for (const auto& rim : geometry.rims())
    for (const Vec3& p : rim) key.insert(key.end(), p.data(), p.data() + 3);
  // Kept for the worlds of this process, as it takes a millisecond. Never destroyed: a world may be
  // made while static objects are destroyed.
  static auto& kept = *new Memo<std::vector<double>, double>;
  return kept.at(key, [&] { return compute_area_factor(geometry, cell, scheme); });
}

}  // namespace navvy::soil
