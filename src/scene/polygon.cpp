// SPDX-License-Identifier: Apache-2.0
#include "scene/polygon.h"

#include <algorithm>

#include "core/limits.h"

namespace navvy::scene {
namespace {

/// Returns the side of the line a-b on which c is: above 0 left, 0 on it.
double side(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Returns true if two edges without a common corner meet.
/// The boxes of the edges decide where all four points are on one line, which the signs cannot.
bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0 &&
         std::max(a.x(), b.x()) >= std::min(c.x(), d.x()) &&
         std::max(c.x(), d.x()) >= std::min(a.x(), b.x()) &&
         std::max(a.y(), b.y()) >= std::min(c.y(), d.y()) &&
         std::max(c.y(), d.y()) >= std::min(a.y(), b.y());
}

/// Returns a fault unless corners are apart and edges meet at their corners only.
std::optional<PolygonFault> fault_of(const std::vector<Vec2>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % n];
    // The sides of an area rise from its edges; one shorter than 1 mm has no reliable direction.
    if ((b - a).norm() < 1e-3)
      return PolygonFault{std::to_string(i + 1), "this corner and the next are the same place",
                          "remove one; the polygon closes by itself"};
    // Neighbouring edges share a corner and are left out, the first and the last one too.
    for (std::size_t k = i + 2; k < n && !(i == 0 && k == n - 1); ++k)
      if (cross(a, b, polygon[k], polygon[(k + 1) % n]))
        return PolygonFault{std::to_string(i + 1) + " and " + std::to_string(k + 1),
                            "the edges that begin at these corners cross",
                            "list the corners once round the area"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<PolygonFault> polygon_of(const std::vector<double>& numbers,
                                       std::vector<Vec2>& corners) {
  corners.clear();
  if (numbers.size() < 6 || numbers.size() % 2 != 0 || numbers.size() > 2 * limits::kDesignCorners)
    return PolygonFault{
        std::to_string(numbers.size()) + " numbers",
        "a polygon is x and y of 3 to " + std::to_string(limits::kDesignCorners) + " corners",
        "e.g. 0 0 4 0 4 2 0 2"};
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    corners.emplace_back(numbers[i], numbers[i + 1]);
  return fault_of(corners);
}

bool contains(const std::vector<Vec2>& polygon, const Vec2& p) {
  bool out = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    // Counts the edges that cross the ray from p towards +x.
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
      out = !out;
  }
  return out;
}

Vec2 longest_edge(const std::vector<Vec2>& polygon) {
  Vec2 out = Vec2::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (edge.norm() > out.norm()) out = edge;
  }
  return out;
}

}  // namespace navvy::scene
