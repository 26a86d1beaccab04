// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/held_space.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace navvy::soil {
namespace {

/// Cells along the longest edge of the box. More would need more first queries and memory, fewer
/// would list more planes.
constexpr int kCells = 24;
/// A cell is in or out as a whole if it is so by this margin, which covers rounding [m].
constexpr double kMargin = 1e-9;

}  // namespace

HeldSpace::HeldSpace(const ShellGeometry& geometry) : geometry_(geometry) {
  low_ = high_ = geometry.hull_points().front();
  for (const Vec3& p : geometry.hull_points()) {
    low_ = low_.min(p.array());
    high_ = high_.max(p.array());
  }
  edge_ = (high_ - low_).maxCoeff() / kCells;
  count_ = ((high_ - low_) / edge_).ceil().cast<int>().min(kCells).max(1);
}

bool HeldSpace::holds(const Vec3& p) {
  // Also taken by a point that is not finite. The hull's planes reject nearly all others there.
  if (!(p.array() >= low_).all() || !(p.array() <= high_).all()) return geometry_.holds(p);
  if (cells_.empty()) cells_.resize(static_cast<std::size_t>(count_.prod()));
  const Eigen::Array3i at = ((p.array() - low_) / edge_).cast<int>().min(count_ - 1);
  Cell& cell =
      cells_[static_cast<std::size_t>(at.x() + count_.x() * (at.y() + count_.y() * at.z()))];
  if (cell.held == Part::kUnknown) cell = classify(at);
  if (cell.held != Part::kSome) return cell.held == Part::kAll;
  const Edge& edge = edges_[cell.edge];
  for (const geometry::Plane& plane : edge.hull)
    if (plane.normal.dot(p) > plane.offset) return false;
  // The triangles at the closest face, edge or corner are all in the list. A point in front of all
  // their planes is in front of the shell, as the pseudo-normal there is a sum of their normals
  // with positive weights.
  bool front = true, back = true;
  for (const geometry::Plane& plate : edge.plates) {
    const double height = plate.normal.dot(p) - plate.offset;
    front = front && height > kMargin;
    back = back && height < -kMargin;
  }
  if (front || back) return front;
  return geometry_.nearest(p, edge.triangles).distance > 0;
}

bool HeldSpace::find_hull(const Vec3& centre, Edge& edge) const {
  for (const geometry::Plane& plane : geometry_.hull()) {
    const double above = plane.normal.dot(centre) - plane.offset;
    const double reach = 0.5 * edge_ * plane.normal.cwiseAbs().sum() + kMargin;
    if (above > reach) return false;
    if (above > -reach) edge.hull.push_back(plane);
  }
  return true;
}

HeldSpace::Part HeldSpace::find_triangles(const Vec3& centre, Edge& edge) {
  // A triangle can be closest to a point of the cell if it is not farther from the centre than the
  // closest one by more than the cell's diagonal.
  const double farthest =
      std::abs(geometry_.distance(centre, closest_)) + std::sqrt(3.0) * edge_ + kMargin;
  bool front = true, back = true;
  for (int n = 0; n < static_cast<int>(geometry_.triangles().size()); ++n) {
    const ShellGeometry::Triangle& t = geometry_.triangles()[static_cast<std::size_t>(n)];
    if ((centre - t.centre).norm() > farthest + t.radius ||
        geometry_.distance_to(n, centre) > farthest)
      continue;
    edge.triangles.push_back(n);
    edge.plates.push_back({t.normal, t.normal.dot(t.corner[0])});
    const double height = t.normal.dot(centre - t.corner[0]);
    const double reach = 0.5 * edge_ * t.normal.cwiseAbs().sum() + kMargin;
    front = front && height > reach;
    back = back && height < -reach;
  }
  return front ? Part::kAll : back ? Part::kNone : Part::kSome;
}

HeldSpace::Cell HeldSpace::classify(const Eigen::Array3i& at) {
  const Vec3 centre = (low_ + edge_ * (at.cast<double>() + 0.5)).matrix();
  Edge edge;
  if (!find_hull(centre, edge)) return {Part::kNone};
  const Part front = find_triangles(centre, edge);
  if (front == Part::kNone) return {Part::kNone};
  if (front == Part::kAll) {
    if (edge.hull.empty()) return {Part::kAll};
    edge.triangles.clear();
    edge.plates.clear();
  }
  edges_.push_back(std::move(edge));
  return {Part::kSome, static_cast<std::uint16_t>(edges_.size() - 1)};
}

}  // namespace navvy::soil
