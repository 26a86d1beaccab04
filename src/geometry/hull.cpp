// SPDX-License-Identifier: Apache-2.0
// Points are inserted one by one in lexicographic order: each removes the triangles that it sees
// and closes the hole with a fan. Own code, since Bullet's hull is not available in the core build,
// which has no Bullet but needs hulls for the soil.
#include "geometry/hull.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>

#include "core/error.h"

namespace navvy::geometry {
namespace {

// Three points, counter-clockwise from outside.
using Index = std::array<int, 3>;
// A point in steps from the low corner of the box.
using Lattice = std::array<std::int64_t, 3>;

// 2^40 steps over the longest side of the box.
constexpr double kLatticeSteps = 1099511627776.0;
// Tolerance of a plane, relative to the box's diagonal.
constexpr double kSamePlane = 1e-7;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

[[noreturn]] void refuse(const std::string& rule) {
  Fault fault;
  fault.element = "convex hull";
  fault.rule = rule;
  throw InputError(fault);
}

/// Returns the normal of a triangle, which is zero if and only if its corners are collinear.
std::array<__int128, 3> cross(const Lattice& a, const Lattice& b, const Lattice& c) {
  std::array<__int128, 3> u{}, w{};
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    w[k] = c[k] - a[k];
  }
  return {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
}

/// Returns six times the volume of the tetrahedron. Exact: differences have 41 bits, so the sum has
/// at most 125.
__int128 orient(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& p) {
  const std::array<__int128, 3> n = cross(a, b, c);
  return n[0] * (p[0] - a[0]) + n[1] * (p[1] - a[1]) + n[2] * (p[2] - a[2]);
}

/// Returns the points on the lattice. Of two points that coincide there, the second sees no
/// triangle and is left out.
std::vector<Lattice> snap(const std::vector<Vec3>& points, const Vec3& low, double extent) {
  std::vector<Lattice> out;
  out.reserve(points.size());
  for (const Vec3& p : points) {
    Lattice q{};
    for (int k = 0; k < 3; ++k) q[at(k)] = std::llround((p[k] - low[k]) / extent * kLatticeSteps);
    out.push_back(q);
  }
  return out;
}

/// Surface that grows point by point.
class HullFaces {
 public:
  explicit HullFaces(const std::vector<Lattice>& points) : points_(points) {}

  /// Builds the hull and returns true, or returns false if all points are coplanar.
  /// @throws InputError if they are collinear.
  bool build() {
    const int n = static_cast<int>(points_.size());
    const auto is_zero = [](const std::array<__int128, 3>& v) {
      return v[0] == 0 && v[1] == 0 && v[2] == 0;
    };
    // Four points that span space; sorted points make the choice repeatable.
    int second = 1, third = 2;
    while (second < n && points_[at(second)] == points_[0]) ++second;
    if (second < n) third = second + 1;
    while (third < n && is_zero(cross(points_[0], points_[at(second)], points_[at(third)])))
      ++third;
    if (third >= n) refuse("needs at least three points that are not collinear");
    int fourth = third + 1;
    while (fourth < n && side({0, second, third}, fourth) == 0) ++fourth;
    if (fourth >= n) return false;
    // The fourth point is behind the first triangle, so that all four face outwards.
    if (side({0, second, third}, fourth) > 0) std::swap(second, third);
    triangles_ = {
        {0, second, third}, {second, 0, fourth}, {third, second, fourth}, {0, third, fourth}};
    for (int p = 1; p < n; ++p)
      if (p != second && p != third && p != fourth) insert(p);
    return true;
  }

  const std::vector<Index>& triangles() const { return triangles_; }

 private:
  /// Returns a positive number if `p` sees the front of the triangle.
  int side(const Index& t, int p) const {
    const __int128 v =
        orient(points_[at(t[0])], points_[at(t[1])], points_[at(t[2])], points_[at(p)]);
    return (v > 0) - (v < 0);
  }

  /// Adds a point. The triangles that it sees strictly are connected, and their outline is one loop
  /// without an edge collinear with the point (else the point would be in the plane of a seen
  /// triangle). A point that sees none is inside or in a face.
  void insert(int p) {
    std::set<std::pair<int, int>> outline;
    std::vector<Index> remaining;
    for (const Index& t : triangles_) {
      if (side(t, p) <= 0) {
        remaining.push_back(t);
        continue;
      }
      // An edge between two seen triangles is traversed in both directions and cancels out.
      for (std::size_t i = 0; i < 3; ++i)
        if (outline.erase({t[(i + 1) % 3], t[i]}) == 0) outline.insert({t[i], t[(i + 1) % 3]});
    }
    // A fan from the point to the outline; sorted edges make the order of triangles repeatable.
    for (const auto& [a, b] : outline) remaining.push_back({a, b, p});
    triangles_ = std::move(remaining);
  }

  const std::vector<Lattice>& points_;
  std::vector<Index> triangles_;
};

/// Plane of a face and the three points that define it.
struct Face {
  Index points;
  Plane plane;
};

/// Returns the plane through three points, oriented so that all points are behind it, or nothing if
/// points lie on both sides.
std::optional<Plane> supporting_plane(const std::vector<Vec3>& points, const Index& t,
                                      double tiny) {
  const Vec3& origin = points[at(t[0])];
  Vec3 n = (points[at(t[1])] - origin).cross(points[at(t[2])] - origin);
  // Collinear within rounding: the normal would be noise.
  if (n.norm() < tiny * tiny) return std::nullopt;
  n.normalize();
  double least = 0, most = 0;
  for (const Vec3& p : points) {
    const double d = n.dot(p - origin);
    least = std::min(least, d);
    most = std::max(most, d);
    if (least < -tiny && most > tiny) return std::nullopt;
  }
  if (most > tiny) n = -n;
  return Plane{n, n.dot(origin)};
}

/// Returns true for planes of one face. Opposite sides of a thin plate have opposite normals and
/// remain two.
bool same_plane(const Plane& a, const Plane& b, double tiny) {
  return (a.normal - b.normal).norm() < 1e-6 && std::abs(a.offset - b.offset) < tiny * 10;
}

/// Returns the face that contains a triangle of the hull, through the first points of that face.
/// Slivers between nearly collinear points may have none; the adjacent faces bound the hull there.
std::optional<Face> face_of(const std::vector<Vec3>& points, const Index& triangle, double tiny) {
  const Vec3& origin = points[at(triangle[0])];
  const Vec3 n =
      (points[at(triangle[1])] - origin).cross(points[at(triangle[2])] - origin).normalized();
  // Twice the tolerance, as the plane through other points of the face may deviate that much from
  // this triangle's.
  std::vector<int> near;
  for (int i = 0; i < static_cast<int>(points.size()); ++i)
    if (std::abs(n.dot(points[at(i)] - origin)) <= 2 * tiny) near.push_back(i);
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t j = i + 1; j < near.size(); ++j)
      for (std::size_t k = j + 1; k < near.size(); ++k) {
        const Index through = {near[i], near[j], near[k]};
        if (const auto plane = supporting_plane(points, through, tiny))
          return Face{through, *plane};
      }
  return std::nullopt;
}

/// Returns the planes of all faces.
std::vector<Plane> planes_of(const std::vector<Vec3>& points, const std::vector<Index>& triangles,
                             double tiny) {
  std::vector<Face> faces;
  for (const Index& t : triangles) {
    // Most triangles of a large face belong to a face that is known already.
    const Vec3 n = (points[at(t[1])] - points[at(t[0])])
                       .cross(points[at(t[2])] - points[at(t[0])])
                       .normalized();
    const bool known = std::any_of(faces.begin(), faces.end(), [&](const Face& face) {
      return same_plane(face.plane, {n, n.dot(points[at(t[0])])}, tiny);
    });
    if (known) continue;
    if (auto face = face_of(points, t, tiny)) faces.push_back(*face);
  }
  // In the order of their points, since the cut of a flat face into triangles is arbitrary.
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.points < b.points; });
  std::vector<Plane> planes;
  for (const Face& face : faces)
    if (std::none_of(planes.begin(), planes.end(),
                     [&](const Plane& p) { return same_plane(p, face.plane, tiny); }))
      planes.push_back(face.plane);
  return planes;
}

}  // namespace

ConvexHull convex_hull(std::vector<Vec3> points) {
  for (const Vec3& p : points)
    if (!p.allFinite()) refuse("points must be finite");
  std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  // The sorted order identifies a point by its index below.
  if (points.size() < 3) refuse("needs at least three points that are not collinear");
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const std::vector<Lattice> lattice = snap(points, low, (high - low).maxCoeff());
  const double tiny = kSamePlane * (high - low).norm();

  // The surface is exact on the lattice; planes pass through the points themselves.
  ConvexHull hull;
  HullFaces surface(lattice);
  if (!surface.build()) {
    // Coplanar points: the first three that are not collinear define the plane.
    for (std::size_t k = 2; k < points.size() && hull.planes.empty(); ++k)
      if (const auto plane = supporting_plane(points, {0, 1, static_cast<int>(k)}, tiny))
        hull.planes = {*plane, {-plane->normal, -plane->offset}};
    return hull;
  }
  hull.planes = planes_of(points, surface.triangles(), tiny);
  hull.mesh.triangles = surface.triangles();
  // Keeps corners only, renumbered in their order.
  std::vector<int> number(points.size(), -1);
  for (const Index& t : hull.mesh.triangles)
    for (const int v : t) number[at(v)] = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(hull.mesh.vertices.size());
    hull.mesh.vertices.push_back(points[i]);
  }
  for (Index& t : hull.mesh.triangles)
    for (int& v : t) v = number[at(v)];
  return hull;
}

}  // namespace navvy::geometry
