// SPDX-License-Identifier: Apache-2.0
#include "session/spill_area.h"

#include <algorithm>
#include <cmath>

namespace navvy::session {
namespace {

/// Finds the x at which edges cross the line of this y, in ascending order: an even number.
void find_crossings(const std::vector<Vec2>& polygon, double y, std::vector<double>& x) {
  x.clear();
  for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
    const Vec2 &a = polygon[i], &b = polygon[k];
    if ((a.y() > y) != (b.y() > y))
      x.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
  }
  std::sort(x.begin(), x.end());
}

/// Returns the index of the first of n cells whose centre is at or beyond `at`; n if there is none.
int first_beyond(double at, double origin, double cell, int n) {
  // Clamped as a double: corners may be far from the site.
  return static_cast<int>(std::clamp(std::ceil((at - origin) / cell - 0.5), 0.0, double(n)));
}

}  // namespace

void mark_inside(const std::vector<Vec2>& polygon, const ColumnRaster& raster,
                 std::vector<std::uint8_t>& marks) {
  if (polygon.empty()) return;
  const auto [low, high] = std::minmax_element(
      polygon.begin(), polygon.end(), [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); });
  const int first = first_beyond(low->y(), raster.origin.y(), raster.cell, raster.ny);
  const int last = first_beyond(high->y(), raster.origin.y(), raster.cell, raster.ny);
  std::vector<double> x;
  for (int iy = first; iy < last; ++iy) {
    find_crossings(polygon, raster.origin.y() + raster.cell * (iy + 0.5), x);
    const auto row =
        marks.begin() + static_cast<std::ptrdiff_t>(iy) * static_cast<std::ptrdiff_t>(raster.nx);
    // Between the first and the second crossing is inside, between the second and the third not.
    for (std::size_t i = 0; i + 1 < x.size(); i += 2)
      std::fill(row + first_beyond(x[i], raster.origin.x(), raster.cell, raster.nx),
                row + first_beyond(x[i + 1], raster.origin.x(), raster.cell, raster.nx),
                std::uint8_t{1});
  }
}

}  // namespace navvy::session
