// SPDX-License-Identifier: Apache-2.0
// A map at its own resolution. It is kept as read and interpolated for each column, instead of being resampled to
// columns at once: a map of 1 m under columns of 0.1 m is a hundredth of their number.
#include "heightfield/raster.h"

#include <algorithm>
#include <cmath>

namespace navvy::heightfield {
namespace {

// A soil cell averages at most this many map cells a side; finer maps are sampled that densely.
constexpr int kMostSamples = 16;

// Mean of the known neighbours of a gap, diagonal ones by 1 / sqrt 2; NaN when there is none.
float mean_of_neighbours(const HeightRaster& raster, int ix, int iy) {
  double sum = 0, weights = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = ix + dx, y = iy + dy;
      if (x < 0 || y < 0 || x >= raster.nx || y >= raster.ny || std::isnan(raster.at(x, y))) continue;
      const double weight = dx != 0 && dy != 0 ? std::sqrt(0.5) : 1.0;
      sum += weight * raster.at(x, y);
      weights += weight;
    }
  // 0 / 0 is the NaN that is wanted.
  return static_cast<float>(sum / weights);
}

}  // namespace

double HeightRaster::sample(double x, double y) const {
  // Outside the outermost centres the nearest value: a site may reach half a cell beyond them.
  const double gx = std::clamp((x - x0) / cell_x, 0.0, nx - 1.0), gy = std::clamp((y - y0) / cell_y, 0.0, ny - 1.0);
  const int ix = static_cast<int>(gx), iy = static_cast<int>(gy);
  const int jx = std::min(ix + 1, nx - 1), jy = std::min(iy + 1, ny - 1);
  const double u = gx - ix, v = gy - iy;
  return (1 - v) * ((1 - u) * at(ix, iy) + u * at(jx, iy)) + v * ((1 - u) * at(ix, jy) + u * at(jx, jy));
}

double HeightRaster::mean(double x, double y, double edge) const {
  const int sx = static_cast<int>(std::clamp(std::ceil(edge / cell_x - 1e-9), 1.0, double{kMostSamples}));
  const int sy = static_cast<int>(std::clamp(std::ceil(edge / cell_y - 1e-9), 1.0, double{kMostSamples}));
  // Where the map is the coarser one, its own smoothness is all there is.
  if (sx == 1 && sy == 1) return sample(x, y);
  double sum = 0;
  for (int j = 0; j < sy; ++j)
    for (int i = 0; i < sx; ++i) sum += sample(x + ((i + 0.5) / sx - 0.5) * edge, y + ((j + 0.5) / sy - 0.5) * edge);
  return sum / (sx * sy);
}

GapFill fill_gaps(HeightRaster& raster) {
  GapFill result;
  result.gaps = std::count_if(raster.z.begin(), raster.z.end(), [](float z) { return std::isnan(z); });
  if (result.gaps == 0) return result;  // as most maps are
  // From the known cells inwards, ring by ring, each cell queued once.
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
  // Each ring sees only the ring before it, so the result does not depend on the order of the cells.
  std::vector<float> values;
  while (!ring.empty()) {
    values.clear();
    for (const std::int64_t i : ring)
      values.push_back(mean_of_neighbours(raster, static_cast<int>(i % raster.nx), static_cast<int>(i / raster.nx)));
    for (std::size_t k = 0; k < ring.size(); ++k) raster.z[static_cast<std::size_t>(ring[k])] = values[k];
    next.clear();
    for (const std::int64_t i : ring) queue_gaps_around(i, next);
    ring.swap(next);
    ++result.farthest;
  }
  return result;
}

SlopeRange slopes(const HeightRaster& raster, double limit) {
  // Tangents, as an angle is needed of three of them only.
  std::vector<float> tangents;
  for (int iy = 0; iy + 1 < raster.ny; ++iy)
    for (int ix = 0; ix + 1 < raster.nx; ++ix) {
      const double a = raster.at(ix, iy), b = raster.at(ix + 1, iy), c = raster.at(ix, iy + 1),
                   d = raster.at(ix + 1, iy + 1);
      tangents.push_back(
          static_cast<float>(std::hypot((b - a + d - c) / (2 * raster.cell_x), (c - a + d - b) / (2 * raster.cell_y))));
    }
  SlopeRange range;
  if (tangents.empty()) return range;
  // Enough order for the median; the rest need not be sorted.
  const auto middle = tangents.begin() + static_cast<std::ptrdiff_t>(tangents.size() / 2);
  std::nth_element(tangents.begin(), middle, tangents.end());
  range.median = std::atan(*middle);
  const auto [least, most] = std::minmax_element(tangents.begin(), tangents.end());
  range.least = std::atan(*least);
  range.most = std::atan(*most);
  const double steep = std::tan(limit);
  const auto above = std::count_if(tangents.begin(), tangents.end(), [&](float t) { return t > steep; });
  range.share_above = static_cast<double>(above) / static_cast<double>(tangents.size());
  return range;
}

}  // namespace navvy::heightfield
