// SPDX-License-Identifier: Apache-2.0
// The surface is bilinear over dual cells, whose corners are four column centres, as in
// heightfield::Terrain.
#include "map/map_queries.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace navvy::map {
namespace {

/// A dual cell, a place in it (u, v in 0..1), and the heights of its corners.
struct Patch {
  double u = 0, v = 0;
  /// Heights at (0,0), (1,0), (0,1), (1,1); NaN where a corner that counts is unknown.
  std::array<double, 4> z{};
  double height() const {
    return (1 - v) * ((1 - u) * z[0] + u * z[1]) + v * ((1 - u) * z[2] + u * z[3]);
  }
};

/// Returns true when W (x, y) is on the site, its edge included; false for NaN.
bool on_site(const TerrainMap& map, double x, double y) {
  const Vec2& low = map.origin();
  const Vec2 high = low + map.cell() * Vec2(map.nx(), map.ny());
  return x >= low.x() && y >= low.y() && x <= high.x() && y <= high.y();
}

// Clamping continues the surface level beyond the outermost centres.
void corners(const TerrainMap& map, int ix, int iy, std::array<double, 4>& z) {
  // Beyond the outermost centres the surface goes on level.
  const int x0 = std::clamp(ix, 0, map.nx() - 1), x1 = std::clamp(ix + 1, 0, map.nx() - 1);
  const int y0 = std::clamp(iy, 0, map.ny() - 1), y1 = std::clamp(iy + 1, 0, map.ny() - 1);
  const auto at = [&](int x, int y) {
    return static_cast<double>(map.at(MapLayer::kElevation, x, y));
  };
  z = {at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)};
}

/// Returns the dual cell around a place on the site.
Patch patch_at(const TerrainMap& map, double x, double y) {
  const double gx = (x - map.origin().x()) / map.cell() - 0.5,
               gy = (y - map.origin().y()) / map.cell() - 0.5;
  const double ix = std::floor(gx), iy = std::floor(gy);
  Patch patch{gx - ix, gy - iy, {}};
  corners(map, static_cast<int>(ix), static_cast<int>(iy), patch.z);
  // At a column's very centre its neighbours do not count, known or not.
  if (patch.u == 0) patch.z[1] = patch.z[0], patch.z[3] = patch.z[2];
  if (patch.v == 0) patch.z[2] = patch.z[0], patch.z[3] = patch.z[1];
  return patch;
}

/// Returns the slopes of the surface along x and y.
Vec2 gradient(const Patch& p, double cell) {
  return Vec2((1 - p.v) * (p.z[1] - p.z[0]) + p.v * (p.z[3] - p.z[2]),
              (1 - p.u) * (p.z[2] - p.z[0]) + p.u * (p.z[3] - p.z[1])) /
         cell;
}

/// Returns the least value of f0 + f1 t + f2 t^2 over 0 <= t <= end.
double least(double f0, double f1, double f2, double end) {
  double low = std::min(f0, f0 + (f1 + f2 * end) * end);
  // The bottom of an upright parabola.
  if (f2 > 0) {
    const double t = -f1 / (2 * f2);
    if (t > 0 && t < end) low = std::min(low, f0 + (f1 + f2 * t) * t);
  }
  return low;
}

}  // namespace

// A value belongs to the square of its column and is not interpolated: an index or a flag cannot
// be.
float value(const TerrainMap& map, MapLayer layer, double x, double y) {
  if (!on_site(map, x, y)) return kUnknown;
  const Vec2 g = (Vec2(x, y) - map.origin()) / map.cell();
  // The far edges belong to the last columns.
  return map.at(layer, std::min(static_cast<int>(g.x()), map.nx() - 1),
                std::min(static_cast<int>(g.y()), map.ny() - 1));
}

double height(const TerrainMap& map, double x, double y) {
  return on_site(map, x, y) ? patch_at(map, x, y).height() : static_cast<double>(kUnknown);
}

std::optional<Vec3> normal(const TerrainMap& map, double x, double y) {
  if (!on_site(map, x, y)) return std::nullopt;
  const Vec2 g = gradient(patch_at(map, x, y), map.cell());
  if (!g.allFinite()) return std::nullopt;
  return Vec3(-g.x(), -g.y(), 1).normalized();
}

// Uses the gradient of the bilinear surface at the place itself.
double slope(const TerrainMap& map, double x, double y) {
  if (!on_site(map, x, y)) return static_cast<double>(kUnknown);
  return std::atan(gradient(patch_at(map, x, y), map.cell()).norm());
}

// Walks the dual cells that the segment crosses. Within one cell the height of the segment above
// the bilinear surface is a quadratic, whose minimum is exact.
Sight line_of_sight(const TerrainMap& map, const Vec3& p, const Vec3& q) {
  if (!p.allFinite() || !q.allFinite()) return Sight::kUnsure;
  // t runs from 0 at p to 1 at q; the site is convex, so the segment is on it where both ends are.
  bool all_known = on_site(map, p.x(), p.y()) && on_site(map, q.x(), q.y());
  const Vec2 g = (p.head<2>() - map.origin()) / map.cell() - Vec2(0.5, 0.5);
  const Vec2 d = (q - p).head<2>() / map.cell();
  // Only that part of the segment is walked which is over the site.
  double begin = 0, end = 1;
  const Vec2 most(map.nx() - 0.5, map.ny() - 0.5);
  for (int axis = 0; axis < 2; ++axis) {
    if (d[axis] == 0 && (g[axis] < -0.5 || g[axis] > most[axis])) return Sight::kUnsure;
    if (d[axis] == 0) continue;
    const double a = (-0.5 - g[axis]) / d[axis], b = (most[axis] - g[axis]) / d[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (begin > end) return Sight::kUnsure;
  Vec2i i = (g + begin * d).array().floor().cast<int>();
  const auto exit_of = [&](int axis) {
    return d[axis] > 0   ? (i[axis] + 1 - g[axis]) / d[axis]
           : d[axis] < 0 ? (i[axis] - g[axis]) / d[axis]
                         : 2.0;
  };
  for (double t0 = begin; t0 <= end;) {
    const double tx = exit_of(0), ty = exit_of(1), t1 = std::min({tx, ty, end});
    std::array<double, 4> z;
    corners(map, i.x(), i.y(), z);
    // Height of the segment above the bilinear surface from the entry on: a quadratic in t.
    const double b = z[1] - z[0], c = z[2] - z[0], e = z[3] - z[2] - b;
    const double u = g.x() + d.x() * t0 - i.x(), v = g.y() + d.y() * t0 - i.y();
    const double f0 = p.z() + (q.z() - p.z()) * t0 - (z[0] + b * u + c * v + e * u * v);
    const double f1 = q.z() - p.z() - b * d.x() - c * d.y() - e * (u * d.y() + v * d.x()),
                 f2 = -e * d.x() * d.y();
    const double low = least(f0, f1, f2, std::max(t1 - t0, 0.0));
    if (low < 0) return Sight::kHidden;
    all_known = all_known && low == low;
    if (t1 >= end) break;
    // Through a corner both move on.
    if (tx <= ty) i.x() += d.x() > 0 ? 1 : -1;
    if (ty <= tx) i.y() += d.y() > 0 ? 1 : -1;
    t0 = std::max(t0, t1);
  }
  return all_known ? Sight::kFree : Sight::kUnsure;
}

}  // namespace navvy::map
