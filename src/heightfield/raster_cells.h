// SPDX-License-Identifier: Apache-2.0
// Functions of a few cells of a map, shared by maps in memory and maps that are read in windows. A
// raster here has nx, ny, cell_x, cell_y, x0, y0 like HeightRaster.
#pragma once

#include <algorithm>
#include <cmath>

namespace navvy::heightfield {

/// Largest number of map cells per side that a soil cell averages; finer maps are sampled that
/// densely.
inline constexpr int kMostSamples = 16;

/// Returns the bilinear height [m]. `corners(ix, iy, jx, jy, z)` fills z with cells (ix, iy), (jx,
/// iy), (ix, jy), (jx, jy), where jx and jy are ix and iy or one more.
template <class Raster, class Corners>
double bilinear(const Raster& raster, double x, double y, const Corners& corners) {
  // Outside the outermost centres the nearest value: a site may reach half a cell beyond them.
  const double gx = std::clamp((x - raster.x0) / raster.cell_x, 0.0, raster.nx - 1.0);
  const double gy = std::clamp((y - raster.y0) / raster.cell_y, 0.0, raster.ny - 1.0);
  const int ix = static_cast<int>(gx), iy = static_cast<int>(gy);
  const double u = gx - ix, v = gy - iy;
  float z[4];
  corners(ix, iy, std::min(ix + 1, raster.nx - 1), std::min(iy + 1, raster.ny - 1), z);
  return (1 - v) * ((1 - u) * z[0] + u * z[1]) + v * ((1 - u) * z[2] + u * z[3]);
}

/// Returns the mean of `sample(x, y)` over a square of `edge` [m] around (x, y): one sample where
/// the map is coarser than that.
template <class Raster, class Sample>
double mean_of_samples(const Raster& raster, double x, double y, double edge,
                       const Sample& sample) {
  const int sx = static_cast<int>(
      std::clamp(std::ceil(edge / raster.cell_x - 1e-9), 1.0, double{kMostSamples}));
  const int sy = static_cast<int>(
      std::clamp(std::ceil(edge / raster.cell_y - 1e-9), 1.0, double{kMostSamples}));
  // Where the map is the coarser one, its own smoothness is all there is.
  if (sx == 1 && sy == 1) return sample(x, y);
  double sum = 0;
  for (int j = 0; j < sy; ++j)
    for (int i = 0; i < sx; ++i)
      sum += sample(x + ((i + 0.5) / sx - 0.5) * edge, y + ((j + 0.5) / sy - 0.5) * edge);
  return sum / (sx * sy);
}

/// Returns the mean of the known cells among the eight neighbours of a gap, diagonal ones weighted
/// by 1 / sqrt 2; NaN when none is known. `at(ix, iy)` returns a cell, NaN where it is not known.
template <class Raster, class At>
float mean_of_neighbours(const Raster& raster, int ix, int iy, const At& at) {
  double sum = 0, weights = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = ix + dx, y = iy + dy;
      if ((dx == 0 && dy == 0) || x < 0 || y < 0 || x >= raster.nx || y >= raster.ny) continue;
      const float z = at(x, y);
      if (std::isnan(z)) continue;
      const double weight = dx != 0 && dy != 0 ? std::sqrt(0.5) : 1.0;
      sum += weight * static_cast<double>(z);
      weights += weight;
    }
  // 0 / 0 is the NaN that is wanted.
  return static_cast<float>(sum / weights);
}

/// Returns the tangent of the mean gradient of the 2 x 2 cells a (least x and y), b, c (larger y),
/// d.
template <class Raster>
float tangent(const Raster& raster, double a, double b, double c, double d) {
  return static_cast<float>(
      std::hypot((b - a + d - c) / (2 * raster.cell_x), (c - a + d - b) / (2 * raster.cell_y)));
}

}  // namespace navvy::heightfield
