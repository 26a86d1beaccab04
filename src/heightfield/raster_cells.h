// SPDX-License-Identifier: Apache-2.0
// Formulas for a few cells of a height map, shared by HeightRaster and WindowedRaster. A template
// parameter `Raster` stands for a type with the members nx, ny, cell_x, cell_y, x0 and y0 of
// HeightRaster.
#pragma once

#include <algorithm>
#include <cmath>

namespace navvy::heightfield {

/// Maximum number of samples along each side of a terrain column when the heights of a finer map
/// are averaged over the column.
inline constexpr int kMostSamples = 16;

/// Returns the height of a map at position (x, y) [m], interpolated bilinearly between cell
/// centres.
/// @param corners function `corners(ix, iy, jx, jy, z)` that writes the heights of cells (ix, iy),
/// (jx, iy), (ix, jy) and (jx, jy) to z[0] to z[3]; jx is ix or ix + 1, and jy is iy or iy + 1.
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

/// Returns the mean of `sample(x, y)` over a square with edge `edge` [m] around (x, y) [m]. It is a
/// single sample if the map's cells are not smaller than the square.
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

/// Returns the mean height of the known cells among the eight neighbours of cell (ix, iy); NaN if
/// none is known. Diagonal neighbours have the weight 1 / sqrt(2). `at(ix, iy)` returns the height
/// of a cell, or NaN if it is unknown.
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

/// Returns the tangent of the slope of four neighbouring cells, from their mean gradient. The
/// heights [m] are `a` at (ix, iy), `b` at (ix + 1, iy), `c` at (ix, iy + 1) and `d` at (ix + 1, iy
/// + 1).
template <class Raster>
float tangent(const Raster& raster, double a, double b, double c, double d) {
  return static_cast<float>(
      std::hypot((b - a + d - c) / (2 * raster.cell_x), (c - a + d - b) / (2 * raster.cell_y)));
}

}  // namespace navvy::heightfield
