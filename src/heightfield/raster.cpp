// SPDX-License-Identifier: Apache-2.0
// A map keeps its own resolution and is interpolated for each column instead of being resampled: a
// map of 1 m under columns of 0.1 m has a hundredth of their number.
#include "heightfield/raster.h"

#include <algorithm>
#include <cmath>

#include "heightfield/raster_cells.h"

namespace navvy::heightfield {
double HeightRaster::sample(double x, double y) const {
  return bilinear(*this, x, y, [&](int ix, int iy, int jx, int jy, float* corners) {
    corners[0] = at(ix, iy), corners[1] = at(jx, iy), corners[2] = at(ix, jy),
    corners[3] = at(jx, jy);
  });
}

double HeightRaster::mean(double x, double y, double edge) const {
  return mean_of_samples(*this, x, y, edge, [&](double px, double py) { return sample(px, py); });
}

// Breadth first from the known cells, so that a gap is filled from its nearest ones.
GapFill fill_gaps(HeightRaster& raster) {
  GapFill result;
  result.gaps =
      std::count_if(raster.z.begin(), raster.z.end(), [](float z) { return std::isnan(z); });
  if (result.gaps == 0) return result;  // as most maps are
  // Works from the known cells inwards, ring by ring; each cell is queued once.
  std::vector<std::int64_t> ring, next;
  std::vector<char> queued(raster.z.size(), 0);
  const auto queue_gaps_around = [&](std::int64_t i, std::vector<std::int64_t>& out) {
    const int ix = static_cast<int>(i % raster.nx), iy = static_cast<int>(i / raster.nx);
    for (int y = std::max(iy - 1, 0); y <= std::min(iy + 1, raster.ny - 1); ++y)
      for (int x = std::max(ix - 1, 0); x <= std::min(ix + 1, raster.nx - 1); ++x) {
        const std::int64_t k = static_cast<std::int64_t>(y) * raster.nx + x;
        char& mark = queued[static_cast<std::size_t>(k)];
        if (mark != 0 || !std::isnan(raster.at(x, y))) continue;
        mark = 1;
        out.push_back(k);
      }
  };
  for (std::size_t i = 0; i < raster.z.size(); ++i)
    if (!std::isnan(raster.z[i])) queue_gaps_around(static_cast<std::int64_t>(i), ring);
  // Each ring depends on the ring before only, so the result does not depend on the order of the
  // cells.
  std::vector<float> values;
  while (!ring.empty()) {
    values.clear();
    for (const std::int64_t i : ring)
      values.push_back(mean_of_neighbours(raster, static_cast<int>(i % raster.nx),
                                          static_cast<int>(i / raster.nx),
                                          [&](int x, int y) { return raster.at(x, y); }));
    for (std::size_t k = 0; k < ring.size(); ++k)
      raster.z[static_cast<std::size_t>(ring[k])] = values[k];
    next.clear();
    for (const std::int64_t i : ring) queue_gaps_around(i, next);
    ring.swap(next);
    ++result.farthest;
  }
  return result;
}

SlopeRange slopes(const HeightRaster& raster, double limit) {
  // Compares tangents, because only three values need an angle.
  std::vector<float> tangents;
  for (int iy = 0; iy + 1 < raster.ny; ++iy)
    for (int ix = 0; ix + 1 < raster.nx; ++ix) {
      tangents.push_back(tangent(raster, raster.at(ix, iy), raster.at(ix + 1, iy),
                                 raster.at(ix, iy + 1), raster.at(ix + 1, iy + 1)));
    }
  SlopeRange range;
  if (tangents.empty()) return range;
  // A partial sort suffices for the median.
  const auto middle = tangents.begin() + static_cast<std::ptrdiff_t>(tangents.size() / 2);
  std::nth_element(tangents.begin(), middle, tangents.end());
  range.median = std::atan(*middle);
  const auto [least, most] = std::minmax_element(tangents.begin(), tangents.end());
  range.least = std::atan(*least);
  range.most = std::atan(*most);
  const double steep = std::tan(limit);
  const auto above =
      std::count_if(tangents.begin(), tangents.end(), [&](float t) { return t > steep; });
  range.share_above = static_cast<double>(above) / static_cast<double>(tangents.size());
  return range;
}

}  // namespace navvy::heightfield
