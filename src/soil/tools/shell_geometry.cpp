// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/shell_geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"

namespace navvy::soil {
namespace {

[[noreturn]] void refuse(const scene::Shell& shell, const std::string& value,
                         const std::string& rule) {
  Fault fault;
  fault.element = "shell[" + shell.name + "]/triangles";
  fault.value = value;
  fault.rule = rule;
  fault.remedy = "correct the shell's mesh";
  throw InputError(fault);
}

/// Folds of a closed body that turn by more than this act like edges [cos]: 30 degrees.
constexpr double kSharp = 0.866;

/// Faces that share an edge. An edge of one face is free: soil can pass around it.
struct EdgeUse {
  int count = 0;
  Vec3 normal = Vec3::Zero();
  /// Folds away from the front.
  bool sharp = false;
};

/// Returns the same key for both directions of an edge.
std::pair<int, int> edge_key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Returns the point of segment a b closest to p; t = its position along the segment [0, 1].
Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b, double& t) {
  const Vec3 ab = b - a;
  t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return a + t * ab;
}

}  // namespace

ShellGeometry::ShellGeometry(const scene::Shell& shell, double cell) : shell_(shell) {
  if (shell.triangles.empty()) refuse(shell, "0", "at least one triangle");
  for (const auto& t : shell.triangles)
    for (const int v : t)
      if (v < 0 || v >= static_cast<int>(shell.vertices.size()))
        refuse(shell, std::to_string(v),
               "vertex indices below " + std::to_string(shell.vertices.size()));
  find_normals();
  pieces_ = geometry::cut_to_pieces(shell, geometry::kShellPieceCells * cell);
  build_hull();
}

void ShellGeometry::find_normals() {
  std::map<std::pair<int, int>, EdgeUse> edges;
  std::map<int, Vec3> corner_normals;
  std::map<int, bool> corner_free;
  for (const auto& index : shell_.triangles) {
    Triangle t;
    for (std::size_t i = 0; i < 3; ++i)
      t.corner[i] = shell_.vertices[static_cast<std::size_t>(index[i])];
    const Vec3 area = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
    if (!(area.norm() > 1e-10)) refuse(shell_, "a triangle without area", "an area above 1e-10 m2");
    t.normal = area.normalized();
    t.radius = 0;
    t.centre = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
    for (const Vec3& corner : t.corner) t.radius = std::max(t.radius, (corner - t.centre).norm());
    for (std::size_t i = 0; i < 3; ++i) {
      EdgeUse& use = edges[edge_key(index[i], index[(i + 1) % 3])];
      const bool away = use.normal.dot(t.corner[(i + 2) % 3] - t.corner[i]) < 0;
      use.sharp = use.count == 1 && away && use.normal.dot(t.normal) < kSharp;
      ++use.count;
      use.normal += t.normal;
      // The pseudo-normal of a corner weights each face by its angle there.
      const Vec3 u = (t.corner[(i + 1) % 3] - t.corner[i]).normalized();
      const Vec3 w = (t.corner[(i + 2) % 3] - t.corner[i]).normalized();
      const double angle = std::acos(std::clamp(u.dot(w), -1.0, 1.0));
      corner_normals.try_emplace(index[i], Vec3::Zero()).first->second += angle * t.normal;
    }
    triangles_.push_back(t);
  }
  // A body without free edges: nodes reach around its sharp edges as far as around free ones, and
  // are weighted less near them in the same way. Otherwise it would act a cell larger on every
  // side. Its particles stay outside as at any fold.
  const bool closed = std::none_of(edges.begin(), edges.end(),
                                   [](const auto& edge) { return edge.second.count == 1; });
  for (const auto& [key, use] : edges) {
    const bool free = use.count == 1;
    if (free) corner_free[key.first] = corner_free[key.second] = true;
    if (free || (closed && use.sharp))
      rims_.push_back({shell_.vertices[static_cast<std::size_t>(key.first)],
                       shell_.vertices[static_cast<std::size_t>(key.second)]});
  }
  // The normals of edges and corners are sums over all faces, so they are copied to the triangles
  // last.
  for (std::size_t n = 0; n < triangles_.size(); ++n) {
    const auto& index = shell_.triangles[n];
    for (std::size_t i = 0; i < 3; ++i) {
      const EdgeUse& use = edges[edge_key(index[i], index[(i + 1) % 3])];
      triangles_[n].edge_normal[i] = use.normal;
      triangles_[n].edge_free[i] = use.count == 1;
      triangles_[n].corner_normal[i] = corner_normals[index[i]];
      triangles_[n].corner_free[i] = corner_free.count(index[i]) != 0;
    }
  }
}

void ShellGeometry::build_hull() {
  // The mouth opens in the mean direction of the faces; a heap may rise above it by a quarter of
  // the shell's size.
  Vec3 mouth = Vec3::Zero();
  for (const Triangle& t : triangles_)
    mouth += (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
  const geometry::Box box = geometry::bounds(shell_);
  const double heap = mouth.norm() > 1e-9 ? 0.25 * (box.high - box.low).norm() : 0;
  std::vector<Vec3> points;
  for (const Triangle& t : triangles_)
    // The hull of an open shell is what it can hold, level with its rims, plus the heap.
    points.insert(points.end(), t.corner.begin(), t.corner.end());
  if (heap > 0)
    for (const auto& rim : rims_)
      for (const Vec3& p : rim) points.push_back(p + heap * mouth.normalized());
  hull_ = geometry::convex_hull(points).planes;
  hull_points_ = std::move(points);
}

double ShellGeometry::distance(const Vec3& p) const {
  int closest = 0;
  return distance(p, closest);
}

namespace {

/// Search for the point of a shell closest to a given point.
class NearestSearch {
 public:
  NearestSearch(const std::vector<ShellGeometry::Triangle>& triangles, const Vec3& p)
      : triangles_(triangles), p_(p) {}

  /// Takes triangle `n` into account.
  void look(int n) {
    const ShellGeometry::Triangle& t = triangles_[static_cast<std::size_t>(n)];
    // A triangle whose plane or bounding sphere is farther than the best distance cannot be closer;
    // the margin covers rounding.
    const double height = t.normal.dot(p_ - t.corner[0]);
    if (height * height > best_ * (1 + 1e-9)) return;
    const double reach = (std::sqrt(best_) + t.radius) * (1 + 1e-9);
    if ((p_ - t.centre).squaredNorm() > reach * reach) return;
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 along = t.corner[(i + 1) % 3] - t.corner[i];
      inside = inside && t.normal.cross(along).dot(p_ - t.corner[i]) >= 0;
      double share = 0;
      const Vec3 c = closest_on_segment(p_, t.corner[i], t.corner[(i + 1) % 3], share);
      offer(c,
            share <= 0   ? t.corner_normal[i]
            : share >= 1 ? t.corner_normal[(i + 1) % 3]
                         : t.edge_normal[i],
            n);
    }
    if (inside) offer(p_ - height * t.normal, t.normal, n);
  }
  /// Returns the closest point found, and its triangle in `closest`.
  ShellGeometry::Nearest result(int& closest) {
    closest = triangle_;
    out_.distance = ((p_ - out_.place).dot(out_.normal) >= 0 ? 1 : -1) * std::sqrt(best_);
    return out_;
  }

 private:
  // The sign of the distance comes from the pseudo-normal of the closest feature, which is right at
  // edges and corners, where a face normal is not.
  void offer(const Vec3& c, const Vec3& normal, int triangle) {
    const double d2 = (p_ - c).squaredNorm();
    if (d2 >= best_) return;
    best_ = d2;
    out_.place = c;
    out_.normal = normal;
    triangle_ = triangle;
  }

  const std::vector<ShellGeometry::Triangle>& triangles_;
  const Vec3& p_;
  double best_ = 1e300;
  int triangle_ = 0;
  ShellGeometry::Nearest out_;
};

}  // namespace

ShellGeometry::Nearest ShellGeometry::nearest(const Vec3& p, int& closest) const {
  NearestSearch search(triangles_, p);
  // A good guess first makes the rejection tests of the other triangles effective.
  search.look(closest);
  for (int n = 0; n < static_cast<int>(triangles_.size()); ++n)
    if (n != closest) search.look(n);
  return search.result(closest);
}

ShellGeometry::Nearest ShellGeometry::nearest(const Vec3& p, std::span<const int> among) const {
  NearestSearch search(triangles_, p);
  for (const int n : among) search.look(n);
  int closest = 0;
  return search.result(closest);
}

double ShellGeometry::distance_to(int triangle, const Vec3& p) const {
  NearestSearch search(triangles_, p);
  search.look(triangle);
  return std::abs(search.result(triangle).distance);
}

bool ShellGeometry::holds(const Vec3& p) const {
  int closest = 0;
  return holds(p, closest);
}

bool ShellGeometry::holds(const Vec3& p, int& closest) const {
  // The test against a few planes is much cheaper than the distance and rejects most particles.
  for (const geometry::Plane& plane : hull_)
    if (plane.normal.dot(p) > plane.offset) return false;
  return distance(p, closest) > 0;
}

}  // namespace navvy::soil
