// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/ground_shape.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr double kEverywhere = 1e9;  // [m]
constexpr double kRounding = 1e-6;   // of heights between columns [m]
// Cells along a side of one query; beyond it nodes are skipped.
constexpr double kMostCells = 256;

}  // namespace

void GroundShape::getAabb(const btTransform&, btVector3& low, btVector3& high) const {
  low.setValue(-kEverywhere, -kEverywhere, -kEverywhere);
  high.setValue(kEverywhere, kEverywhere, kEverywhere);
}

// Reads the heights of all nodes once, then passes two triangles per cell.
void GroundShape::processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                                      const btVector3& high) const {
  if (ground_ == nullptr) return;
  const terramechanics::GroundLattice lattice = ground_->lattice();
  // A body of a hundred metres meets a coarser ground rather than a million triangles.
  const double span = std::max(high.x() - low.x(), high.y() - low.y()) / lattice.spacing;
  const double step = lattice.spacing * std::max(1.0, std::ceil(span / kMostCells));
  const auto cell_of = [&](double at, double node) {
    return static_cast<int>(std::floor((at - node) / step));
  };
  const int x0 = cell_of(low.x(), lattice.node.x()), x1 = cell_of(high.x(), lattice.node.x()) + 1;
  const int y0 = cell_of(low.y(), lattice.node.y()), y1 = cell_of(high.y(), lattice.node.y()) + 1;
  const auto place = [&](int ix, int iy) { return Vec2(lattice.node + step * Vec2(ix, iy)); };
  // Most of a machine is well above the ground: one query for the whole box of a body. The margin
  // far exceeds rounding.
  if (ground_->highest(place(x0, y0), place(x1, y1)) < low.z() - kRounding) return;
  const int nx = x1 - x0 + 1;
  height_.clear();
  for (int iy = y0; iy <= y1; ++iy)
    for (int ix = x0; ix <= x1; ++ix) {
      const Vec2 p = place(ix, iy);
      height_.push_back(ground_->height(p.x(), p.y()));
    }
  const auto node = [&](int ix, int iy) {
    const Vec2 p = place(ix, iy);
    return btVector3(p.x(), p.y(), height_[static_cast<std::size_t>((iy - y0) * nx + ix - x0)]);
  };
  // Both triangles of a cell share the diagonal from its +x to its +y corner, and face up.
  for (int iy = y0; iy < y1; ++iy)
    for (int ix = x0; ix < x1; ++ix) {
      // Skip a cell below the box.
      const double* row = &height_[static_cast<std::size_t>((iy - y0) * nx + ix - x0)];
      if (std::max({row[0], row[1], row[nx], row[nx + 1]}) < low.z()) continue;
      btVector3 one[3] = {node(ix, iy), node(ix + 1, iy), node(ix, iy + 1)};
      callback->processTriangle(one, ix, 2 * iy);
      btVector3 other[3] = {node(ix + 1, iy), node(ix + 1, iy + 1), node(ix, iy + 1)};
      callback->processTriangle(other, ix, 2 * iy + 1);
    }
}

Vec3 GroundShape::steepness(int ix, int iy, bool lower) const {
  const terramechanics::GroundLattice lattice = ground_->lattice();
  const auto height = [&](int i, int j) {
    const Vec2 p = lattice.node + lattice.spacing * Vec2(ix + i, iy + j);
    return ground_->height(p.x(), p.y());
  };
  const double s = lattice.spacing, right = height(1, 0), left = height(0, 1);
  if (lower) return {(height(0, 0) - right) / s, (height(0, 0) - left) / s, 1};
  return {(left - height(1, 1)) / s, (right - height(1, 1)) / s, 1};
}

// Compares the triangle under the contact with its neighbour across the nearest side.
Vec3 GroundShape::outward(const Vec3& p_W, const Vec3& normal_W) const {
  if (ground_ == nullptr) return normal_W;
  const terramechanics::GroundLattice lattice = ground_->lattice();
  const Vec2 at = (p_W.head<2>() - lattice.node) / lattice.spacing;
  const int ix = static_cast<int>(std::floor(at.x())), iy = static_cast<int>(std::floor(at.y()));
  double u = at.x() - ix, v = at.y() - iy;
  const bool lower = u + v < 1;
  if (!lower) u = 1 - u, v = 1 - v;
  // The neighbour across the nearest side, and its direction, seen from the lower triangle.
  const double across = (1 - u - v) / std::sqrt(2.0);
  Vec3 neighbour;
  Vec2 away;
  if (across <= u && across <= v) {
    neighbour = steepness(ix, iy, !lower), away = Vec2(1, 1);
  } else if (u < v) {
    neighbour = steepness(ix + (lower ? -1 : 1), iy, !lower), away = Vec2(-1, 0);
  } else {
    neighbour = steepness(ix, iy + (lower ? -1 : 1), !lower), away = Vec2(0, -1);
  }
  if (!lower) away = -away;
  const Vec3 here = steepness(ix, iy, lower);
  const Vec3 n = here.normalized();
  // A neighbour that slopes away makes a ridge; one that rises leaves no other direction.
  if (!((neighbour - here).head<2>().dot(away) > 1e-9)) return n;
  const Vec3 ridge = n.cross(neighbour.normalized()).normalized();
  const double most = std::acos(std::clamp(n.dot(neighbour.normalized()), -1.0, 1.0));
  const double angle =
      std::clamp(std::atan2(n.cross(normal_W).dot(ridge), n.dot(normal_W)), 0.0, most);
  return std::cos(angle) * n + std::sin(angle) * ridge.cross(n);
}

}  // namespace navvy::vehicle
