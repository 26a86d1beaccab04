// SPDX-License-Identifier: Apache-2.0
#include "heightfield/occupied_area.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace navvy::heightfield {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns one half of the convex hull of points that are sorted by x, then y, without its last
/// point.
std::vector<Vec2> half_hull(const std::vector<Vec2>& points) {
  std::vector<Vec2> out;
  for (const Vec2& p : points) {
    while (out.size() > 1 && cross(out.back() - out[out.size() - 2], p - out[out.size() - 2]) <= 0)
      out.pop_back();
    out.push_back(p);
  }
  if (out.size() > 1) out.pop_back();
  return out;
}

}  // namespace

// Andrew's monotone chain.
OccupiedArea area_around(const std::vector<Vec3>& points, bool machine) {
  OccupiedArea out{{}, INFINITY, -INFINITY, machine};
  std::vector<Vec2> flat;
  for (const Vec3& p : points) {
    flat.push_back(p.head<2>());
    out.low = std::min(out.low, p.z());
    out.high = std::max(out.high, p.z());
  }
  std::sort(flat.begin(), flat.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  out.outline = half_hull(flat);
  std::reverse(flat.begin(), flat.end());
  const std::vector<Vec2> upper = half_hull(flat);
  out.outline.insert(out.outline.end(), upper.begin(), upper.end());
  return out;
}

// Two convex shapes are apart when a line along an edge of one separates them.
bool meets(const OccupiedArea& area, const Vec2& low, const Vec2& high) {
  Vec2 least = Vec2::Constant(INFINITY), most = -least;
  for (const Vec2& p : area.outline) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  if ((least.array() > high.array()).any() || (most.array() < low.array()).any()) return false;
  const std::array<Vec2, 4> corners = {low, Vec2(high.x(), low.y()), high, Vec2(low.x(), high.y())};
  const std::size_t n = area.outline.size();
  for (std::size_t i = 0; i < n && n > 2; ++i) {
    const Vec2 edge = area.outline[(i + 1) % n] - area.outline[i];
    const auto outside = [&](const Vec2& p) { return cross(edge, p - area.outline[i]) < 0; };
    if (std::all_of(corners.begin(), corners.end(), outside)) return false;
  }
  return true;
}

}  // namespace navvy::heightfield
