// SPDX-License-Identifier: Apache-2.0
#include "geometry/solid_properties.h"

#include <map>
#include <utility>

#include "core/error.h"

namespace navvy::geometry {
namespace {

/// The fault names the mesh as a whole, as a hole belongs to no single triangle.
[[noreturn]] void refuse(const std::string& name, const std::string& rule,
                         const std::string& remedy) {
  Fault fault;
  fault.element = name;
  fault.rule = rule;
  fault.remedy = remedy;
  throw InputError(fault);
}

/// Checks that the surface has no boundary, as the divergence theorem requires: every edge is
/// traversed equally often in both directions.
void require_closed(const TriangleMesh& mesh, const std::string& name) {
  std::map<std::pair<int, int>, int> balance;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  for (const auto& [edge, runs] : balance)
    if (runs != 0)
      refuse(name, "the mesh must enclose a volume, its surface is open or folded back at an edge",
             "close it, with all triangles counter-clockwise as seen from outside");
}

}  // namespace

SolidProperties solid_properties(const TriangleMesh& loose, const std::string& name) {
  require_valid(loose, name);
  const TriangleMesh mesh = welded(loose);
  require_closed(mesh, name);
  // Sums about the centre of the box: about a distant origin, volumes cancel and lose precision.
  const Box box = bounds(mesh);
  const Vec3 middle = 0.5 * (box.low + box.high);
  double six_volumes = 0;
  // 24 times the integral of r.
  Vec3 first = Vec3::Zero();
  // 120 times the integral of r r^T.
  Mat3 second = Mat3::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0) - middle, b = mesh.corner(t, 1) - middle,
               c = mesh.corner(t, 2) - middle;
    // For the tetrahedron (0, a, b, c) of volume d / 6, with s = a + b + c, the integral of r is d
    // s / 24 and that of r r^T is d (a a^T + b b^T + c c^T + s s^T) / 120.
    const double d = a.dot(b.cross(c));
    const Vec3 s = a + b + c;
    six_volumes += d;
    first += d * s;
    second += d * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  const double size = (box.high - box.low).norm();
  // Rounding leaves a tiny volume for a flat mesh.
  if (!(six_volumes > 1e-12 * size * size * size))
    refuse(name, "the mesh must enclose a positive volume",
           "reverse its triangles if it is inside out");
  SolidProperties out;
  out.volume = six_volumes / 6;
  // Parallel axis theorem, from the centre of the box to the centre of mass.
  const Vec3 centre = first / (4 * six_volumes);
  out.p_BCom = middle + centre;
  const Mat3 about_centre = second / 120 - out.volume * centre * centre.transpose();
  const Mat3 inertia = about_centre.trace() * Mat3::Identity() - about_centre;
  // Symmetric to the last bit, whatever the compiler's order of the products.
  out.inertia = 0.5 * (inertia + inertia.transpose());
  return out;
}

}  // namespace navvy::geometry
