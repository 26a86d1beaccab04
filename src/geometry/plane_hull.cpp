// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_hull.h"

#include <algorithm>

namespace navvy::geometry {

std::vector<Vec2> plane_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vec2> out;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = out.size();
    for (const Vec2& p : points) {
      while (out.size() >= start + 2) {
        const Vec2 a = out[out.size() - 1] - out[out.size() - 2], b = p - out[out.size() - 2];
        if (a.x() * b.y() - a.y() * b.x() > 0) break;
        out.pop_back();
      }
      out.push_back(p);
    }
    // The last point begins the other chain.
    if (!out.empty()) out.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return out;
}

}  // namespace navvy::geometry
