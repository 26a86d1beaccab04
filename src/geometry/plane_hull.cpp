// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_hull.h"

#include <algorithm>

namespace navvy::geometry {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

// By the monotone chain algorithm.
std::vector<Vec2> plane_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vec2> hull;
  // Once along the lower side, once back along the upper one. A right turn is no corner.
  for (int side = 0; side < 2; ++side) {
    const std::size_t from = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= from + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    // The last point begins the other side.
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace navvy::geometry
