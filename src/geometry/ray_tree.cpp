// SPDX-License-Identifier: Apache-2.0
#include "geometry/ray_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.h"

namespace navvy::geometry {
namespace {

// Largest number of triangles in a leaf.
constexpr std::uint32_t kLeaf = 4;
// Halving 2^32 triangles takes 32 levels, each with one waiting sibling.
constexpr std::size_t kDepth = 64;

// Distances to boxes carry a few relative rounding errors of 1e-16, and so does a hit on a triangle
// inside. The margin ensures that a box is never farther than a hit in it.
constexpr double kMargin = 1e-12;

/// Shear that aligns a ray with the axis along which it is longest [Woop 2013].
struct Shear {
  int x, y, z;
  double sx, sy, sz;

  explicit Shear(const Vec3& direction) {
    direction.cwiseAbs().maxCoeff(&z);
    x = (z + 1) % 3;
    y = (x + 1) % 3;
    // Preserves the winding, hence the sign of the edge functions.
    if (direction[z] < 0) std::swap(x, y);
    sx = direction[x] / direction[z];
    sy = direction[y] / direction[z];
    sz = 1 / direction[z];
  }
};

/// Returns the distance at which a ray hits a triangle.
std::optional<double> meet(const Vec3& origin, const Shear& s, const std::array<Vec3, 3>& corners) {
  // Corners as seen along the ray.
  std::array<Vec3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 d = corners[i] - origin;
    p[i] = Vec3(d[s.x] - s.sx * d[s.z], d[s.y] - s.sy * d[s.z], s.sz * d[s.z]);
  }
  // Each edge function is computed from the same two numbers in both adjacent triangles, so a ray
  // on the edge is on the border of both and no gap opens. The rounding is equal, as a product does
  // not depend on the order of its factors.
  const double u = p[2].x() * p[1].y() - p[2].y() * p[1].x();
  const double v = p[0].x() * p[2].y() - p[0].y() * p[2].x();
  const double w = p[1].x() * p[0].y() - p[1].y() * p[0].x();
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
  // u, v, w are the areas opposite to the corners, and hence the weights of the corners' distances.
  const double sum = u + v + w;
  // Seen edge-on, or without area.
  if (sum == 0) return std::nullopt;
  const double distance = (u * p[0].z() + v * p[1].z() + w * p[2].z()) / sum;
  if (!(distance >= 0)) return std::nullopt;
  return distance;
}

/// Ray prepared for boxes.
struct Slabs {
  Vec3 origin, inverse;

  Slabs(const Vec3& p, const Vec3& direction) : origin(p), inverse(direction.cwiseInverse()) {}

  /// Returns the distance at which the ray enters the box, reduced by the margin, or nothing if it
  /// misses the box or enters beyond `limit`.
  std::optional<double> enter(const Box& box, double limit) const {
    double near = 0, far = limit;
    for (int k = 0; k < 3; ++k) {
      // Parallel to a plane of the box, a product would be 0 x inf; such a ray is always or never
      // within the slab.
      if (!std::isfinite(inverse[k])) {
        const double slack = kMargin * std::max(std::abs(origin[k]), box.high[k] - box.low[k]);
        if (origin[k] < box.low[k] - slack || origin[k] > box.high[k] + slack) return std::nullopt;
        continue;
      }
      const double a = (box.low[k] - origin[k]) * inverse[k],
                   b = (box.high[k] - origin[k]) * inverse[k];
      // The direction of the ray decides which of the two planes is hit first.
      const double enters = std::min(a, b), leaves = std::max(a, b);
      near = std::max(near, enters - kMargin * std::abs(enters));
      far = std::min(far, leaves + kMargin * std::abs(leaves));
    }
    if (near > far + kMargin * far) return std::nullopt;
    return near;
  }
};

[[noreturn]] void refuse(const std::string& rule) {
  Fault fault;
  fault.element = "ray";
  fault.rule = rule;
  throw InputError(fault);
}

}  // namespace

RayTree::RayTree(const TriangleMesh& mesh, const std::string& name) {
  require_valid(mesh, name);
  std::vector<Vec3> centres;
  // Corners are stored side by side, so that a leaf reads them without indirection.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    triangles_.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
    centres.push_back((triangles_[t][0] + triangles_[t][1] + triangles_[t][2]) / 3);
  }
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  if (order_.empty()) return;
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(order_.size()), centres);
}

void RayTree::split(std::size_t node, std::uint32_t first, std::uint32_t last,
                    const std::vector<Vec3>& centres) {
  Box box{triangles_[order_[first]][0], triangles_[order_[first]][0]};
  Vec3 low = centres[order_[first]], high = low;
  for (std::uint32_t i = first; i < last; ++i) {
    for (const Vec3& corner : triangles_[order_[i]]) {
      box.low = box.low.cwiseMin(corner);
      box.high = box.high.cwiseMax(corner);
    }
    low = low.cwiseMin(centres[order_[i]]);
    high = high.cwiseMax(centres[order_[i]]);
  }
  nodes_[node] = {box, first, last - first};
  if (last - first <= kLeaf) return;
  // Halves of equal number along the longest extent of the centres. The triangle's index breaks
  // ties, so that the tree is equal on every machine.
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(centres[a][axis], a) < std::pair(centres[b][axis], b);
                   });
  // Children are stored side by side. `nodes_` may be reallocated meanwhile, so nodes are referred
  // to by index.
  const std::size_t child = nodes_.size();
  nodes_[node].first = static_cast<std::uint32_t>(child);
  nodes_[node].count = 0;
  nodes_.resize(child + 2);
  split(child, first, middle, centres);
  split(child + 1, middle, last, centres);
}

std::optional<RayHit> RayTree::first_hit(const Vec3& origin, const Vec3& direction,
                                         double reach) const {
  if (!origin.allFinite() || !direction.allFinite()) refuse("origin and direction must be finite");
  if (std::isnan(reach)) refuse("the reach must be a number");
  // Normalised in two steps, so that even a direction of 1e-200 has a length.
  const double longest = direction.cwiseAbs().maxCoeff();
  if (!(longest > 0)) refuse("the direction must have a length");
  const Vec3 along = (direction / longest).normalized();
  if (nodes_.empty()) return std::nullopt;
  const Slabs slabs(origin, along);
  const Shear shear(along);
  // A closer hit replaces `best`, and so does an equally close one of a lower index.
  double best = reach;
  int hit = -1;
  // Distance at which a box is entered, and its node.
  std::array<std::pair<double, std::uint32_t>, kDepth> waiting;
  std::size_t count = 0;
  if (const auto enters = slabs.enter(nodes_[0].box, best)) waiting[count++] = {*enters, 0};
  while (count > 0) {
    const auto [enters, number] = waiting[--count];
    // A closer hit was found since the box was put aside.
    if (enters > best) continue;
    const Node& node = nodes_[number];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const int triangle = static_cast<int>(order_[i]);
      const auto distance = meet(origin, shear, triangles_[order_[i]]);
      if (!distance || *distance > best || (*distance == best && hit >= 0 && triangle > hit))
        continue;
      best = *distance;
      hit = triangle;
    }
    if (node.count > 0) continue;
    // The closer box is visited first and shortens the ray for the other.
    auto left = slabs.enter(nodes_[node.first].box, best),
         right = slabs.enter(nodes_[node.first + 1].box, best);
    const bool left_first = left && (!right || *left <= *right);
    if (left && !left_first) waiting[count++] = {*left, node.first};
    if (right) waiting[count++] = {*right, node.first + 1};
    if (left && left_first) waiting[count++] = {*left, node.first};
  }
  if (hit < 0) return std::nullopt;
  const auto& t = triangles_[static_cast<std::size_t>(hit)];
  return RayHit{hit, best, (t[1] - t[0]).cross(t[2] - t[0]).normalized()};
}

}  // namespace navvy::geometry
