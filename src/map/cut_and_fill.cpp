// SPDX-License-Identifier: Apache-2.0
// The polygon is clipped to a row of columns, and the result to each column. The shoelace formula
// gives the areas; it stays right where clipping leaves edges that run back and forth.
#include "map/cut_and_fill.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"

namespace navvy::map {
namespace {

using Polygon = std::vector<Vec2>;

/// Appends to `out` the part of `in` with sign * (coordinate - line) >= 0 along `axis` [Sutherland
/// 1974].
void clip(const Polygon& in, int axis, double line, double sign, Polygon& out) {
  out.clear();
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Vec2& a = in[i];
    const Vec2& b = in[(i + 1) % in.size()];
    const double da = sign * (a[axis] - line), db = sign * (b[axis] - line);
    if (da >= 0) out.push_back(a);
    // The very line, so that neighbours meet without a gap.
    if ((da < 0) != (db < 0)) {
      Vec2 p = a + (b - a) * (da / (da - db));
      p[axis] = line;
      out.push_back(p);
    }
  }
}

/// Returns the signed area, positive for counter-clockwise polygons.
double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // About a corner: coordinates may be large.
    const Vec2 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// Adds `share` [m2] of one column to the sum.
void add(const TerrainMap& map, MapLayer reference, int ix, int iy, double share, CutFill& sum) {
  const double rise =
      static_cast<double>(map.at(MapLayer::kElevation, ix, iy)) - map.at(reference, ix, iy);
  if (!(rise == rise)) {
    sum.unknown_area += share;
    return;
  }
  sum.area += share;
  if (rise < 0) sum.cut -= rise * share;
  if (rise <= 0) return;
  sum.fill += rise * share;
  // The whole rise is taken to be as dense as its surface.
  const float soil = map.at(MapLayer::kSoil, ix, iy);
  const double bank =
      soil >= 0 ? map.setup().soils[static_cast<std::size_t>(soil)].bank_density : NAN;
  sum.fill_bank += rise * share * static_cast<double>(map.at(MapLayer::kDensity, ix, iy)) / bank;
  sum.active += std::min(rise, static_cast<double>(map.at(MapLayer::kLooseDepth, ix, iy))) * share;
}

// Refuses polygons without an area and references that are not heights, before any column is read.
void require_valid(std::span<const Vec2> polygon, MapLayer reference) {
  const auto fault = [](const std::string& value, const char* rule, const char* remedy) {
    throw InputError(Fault{Fault::Severity::kError, "", 0, "polygon", value, rule, remedy});
  };
  if (polygon.size() < 3)
    fault(std::to_string(polygon.size()) + " corners", "at least three", "add corners");
  for (const Vec2& corner : polygon)
    if (!corner.allFinite())
      fault("a corner that is not finite", "finite coordinates in W", "correct it");
  if (!info(reference).height() || reference == MapLayer::kElevation)
    fault(info(reference).name, "elevation_start or target as reference", "pick one of them");
}

}  // namespace

// Rows are cut first: a column then only clips the few edges that cross its row.
CutFill cut_and_fill(const TerrainMap& map, std::span<const Vec2> polygon, MapLayer reference) {
  require_valid(polygon, reference);
  // In columns about the site's corner, where borders are whole numbers.
  Polygon whole;
  for (const Vec2& corner : polygon) whole.push_back((corner - map.origin()) / map.cell());
  const double square = map.cell() * map.cell(), sign = area(whole) < 0 ? -1 : 1;
  // Vectors kept over all columns: nothing is allocated in the loop.
  CutFill sum;
  Polygon a, row, column;
  double inside = 0;
  const auto range = [](const Polygon& p, int axis, int most, int& first, int& last) {
    const auto [low, high] = std::minmax_element(
        p.begin(), p.end(), [&](const Vec2& l, const Vec2& r) { return l[axis] < r[axis]; });
    first = static_cast<int>(std::clamp(std::floor((*low)[axis]), 0.0, static_cast<double>(most)));
    last = static_cast<int>(std::clamp(std::ceil((*high)[axis]), 0.0, static_cast<double>(most)));
  };
  int y0, y1, x0, x1;
  range(whole, 1, map.ny(), y0, y1);
  for (int iy = y0; iy < y1; ++iy) {
    clip(whole, 1, iy, 1, a);
    clip(a, 1, iy + 1, -1, row);
    if (row.size() < 3) continue;
    range(row, 0, map.nx(), x0, x1);
    for (int ix = x0; ix < x1; ++ix) {
      clip(row, 0, ix, 1, a);
      clip(a, 0, ix + 1, -1, column);
      const double share = column.size() < 3 ? 0 : sign * area(column);
      if (share <= 0) continue;
      inside += share;
      add(map, reference, ix, iy, share * square, sum);
    }
  }
  // What of the polygon is not on the site, up to rounding.
  const double outside = std::abs(area(whole)) - inside;
  if (outside > 1e-9 * std::abs(area(whole))) sum.unknown_area += outside * square;
  return sum;
}

}  // namespace navvy::map
