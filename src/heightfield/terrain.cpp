// SPDX-License-Identifier: Apache-2.0
// Reads the surface of live grounds and views. Between column centres it is bilinear over the dual
// cells, whose corners are four column centres; beyond the outermost centres it continues level.
#include "heightfield/terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navvy::heightfield {
namespace {

// Like std::clamp, but NaN becomes `low` instead of an undefined conversion later.
double bounded(double value, double low, double high) {
  return value > low ? std::min(value, high) : low;
}

// Returns the smallest t in [0, range] with f0 + f1 t + f2 t^2 <= 0; negative when there is none.
double first_root(double f0, double f1, double f2, double range) {
  // Already at or below the surface.
  if (f0 <= 0) return 0;
  const double end = f0 + (f1 + f2 * range) * range;
  // Roots by the form that does not cancel [Press 2007].
  const double discriminant = f1 * f1 - 4 * f2 * f0;
  if (discriminant >= 0) {
    const double q = -0.5 * (f1 + std::copysign(std::sqrt(discriminant), f1));
    double best = -1;
    for (const double t : {q != 0 ? f0 / q : -1.0, f2 != 0 ? q / f2 : -1.0})
      if (t >= 0 && t <= range && (best < 0 || t < best)) best = t;
    if (best >= 0) return best;
  }
  return end <= 0 ? range : -1;
}

}  // namespace

// The table is empty: nothing differs from the untouched site yet.
Terrain::Terrain(std::shared_ptr<const StartHeights> start)
    : start_(std::move(start)), setup_(&start_->site().setup()), table_(start_->site()) {}

Vec2i Terrain::column_at(double x, double y) const {
  // Far outside it saturates: no undefined conversion, and still outside.
  const double far = 1e9;
  return {static_cast<int>(bounded(std::floor((x - origin().x()) / cell()), -far, far)),
          static_cast<int>(bounded(std::floor((y - origin().y()) / cell()), -far, far))};
}

// A touched tile keeps the initial heights beside the present ones.
double Terrain::start_height(int ix, int iy) const {
  ix = std::clamp(ix, 0, nx() - 1);
  iy = std::clamp(iy, 0, ny() - 1);
  const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
  return tile != nullptr ? (*tile->start)[static_cast<std::size_t>(index_in_tile(ix, iy))]
                         : start_->height(ix, iy);
}

// A tile stores the soil only where it differs from the start.
std::uint16_t Terrain::surface_soil(int ix, int iy) const {
  ix = std::clamp(ix, 0, nx() - 1);
  iy = std::clamp(iy, 0, ny() - 1);
  // Most columns of a touched tile still show their initial soil.
  const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
  const std::uint16_t soil = tile != nullptr
                                 ? tile->soil[static_cast<std::size_t>(index_in_tile(ix, iy))]
                                 : kSoilAsAtStart;
  return soil != kSoilAsAtStart ? soil : start_->site().surface_soil(ix, iy);
}

float Terrain::specific_volume(int ix, int iy) const {
  ix = std::clamp(ix, 0, nx() - 1);
  iy = std::clamp(iy, 0, ny() - 1);
  const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
  return tile != nullptr ? tile->specific_volume[static_cast<std::size_t>(index_in_tile(ix, iy))]
                         : 1.0f;
}

float Terrain::loose_depth(int ix, int iy) const {
  ix = std::clamp(ix, 0, nx() - 1);
  iy = std::clamp(iy, 0, ny() - 1);
  const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
  return tile != nullptr && tile->loose
             ? (*tile->loose)[static_cast<std::size_t>(index_in_tile(ix, iy))]
             : 0.0f;
}

// Heights at the corners (ix, iy), (ix+1, iy), (ix, iy+1), (ix+1, iy+1) of the dual cell between
// column centres.
void Terrain::corners(int ix, int iy, double z[4]) const {
  // Most dual cells lie within one tile, which is then found once.
  if (ix >= 0 && iy >= 0 && ix + 1 < nx() && iy + 1 < ny() && ix % kTileSide + 1 < kTileSide &&
      iy % kTileSide + 1 < kTileSide) {
    const SurfaceTile* tile = table_.find(ix / kTileSide, iy / kTileSide);
    const TileHeights* heights =
        tile != nullptr ? &tile->height : start_->tile(ix / kTileSide, iy / kTileSide);
    if (heights != nullptr) {
      const double* h = heights->data() + index_in_tile(ix, iy);
      z[0] = h[0], z[1] = h[1], z[2] = h[kTileSide], z[3] = h[kTileSide + 1];
      return;
    }
  }
  // At the seams of tiles and at the edge of the site, column by column.
  z[0] = height(ix, iy), z[1] = height(ix + 1, iy);
  z[2] = height(ix, iy + 1), z[3] = height(ix + 1, iy + 1);
}

// Finds the dual cell that holds W (x, y) and the position in it, 0..1; far outside the site the
// last one.
void Terrain::locate(double x, double y, int& ix, int& iy, double& u, double& v) const {
  const double gx = bounded((x - origin().x()) / cell() - 0.5, -1, nx());
  const double gy = bounded((y - origin().y()) / cell() - 0.5, -1, ny());
  ix = static_cast<int>(std::floor(gx));
  iy = static_cast<int>(std::floor(gy));
  u = gx - ix;
  v = gy - iy;
}

double Terrain::sample(double x, double y) const {
  int ix, iy;
  double u, v, z[4];
  locate(x, y, ix, iy, u, v);
  corners(ix, iy, z);
  return (1 - v) * ((1 - u) * z[0] + u * z[1]) + v * ((1 - u) * z[2] + u * z[3]);
}

Vec3 Terrain::normal(double x, double y) const {
  // Slopes of the bilinear patch at this point, not at the middle of the cell.
  int ix, iy;
  double u, v, z[4];
  locate(x, y, ix, iy, u, v);
  corners(ix, iy, z);
  const double dx = ((1 - v) * (z[1] - z[0]) + v * (z[3] - z[2])) / cell();
  const double dy = ((1 - u) * (z[2] - z[0]) + u * (z[3] - z[1])) / cell();
  return Vec3(-dx, -dy, 1).normalized();
}

// Finds each tile once and reads its rows without a look-up per column.
double Terrain::highest(const CellRect& rect) const {
  double out = -std::numeric_limits<double>::infinity();
  if (rect.empty()) return out;
  const int x0 = std::clamp(rect.x0, 0, nx() - 1), x1 = std::clamp(rect.x1 - 1, 0, nx() - 1);
  const int y0 = std::clamp(rect.y0, 0, ny() - 1), y1 = std::clamp(rect.y1 - 1, 0, ny() - 1);
  for (int ty = y0 / kTileSide; ty <= y1 / kTileSide; ++ty)
    for (int tx = x0 / kTileSide; tx <= x1 / kTileSide; ++tx) {
      const int left = std::max(x0 - tx * kTileSide, 0),
                right = std::min(x1 - tx * kTileSide, kTileSide - 1);
      const int front = std::max(y0 - ty * kTileSide, 0),
                back = std::min(y1 - ty * kTileSide, kTileSide - 1);
      const SurfaceTile* tile = table_.find(tx, ty);
      const TileHeights* heights = tile != nullptr ? &tile->height : start_->tile(tx, ty);
      for (int iy = front; iy <= back; ++iy)
        for (int ix = left; ix <= right; ++ix)
          out = std::max(out, heights != nullptr
                                  ? (*heights)[static_cast<std::size_t>(index_in_tile(ix, iy))]
                                  : start_->height(tx * kTileSide + ix, ty * kTileSide + iy));
    }
  return out;
}

void Terrain::copy_heights(const CellRect& rect, std::vector<float>& out) const {
  out.clear();
  if (rect.empty()) return;
  out.resize(static_cast<std::size_t>(rect.x1 - rect.x0) *
             static_cast<std::size_t>(rect.y1 - rect.y0));
  // Goes tile by tile, so that each untouched tile is computed once and none displaces those that
  // wheels and soil read.
  TileHeights buffer;
  const auto tile_of = [](int i, int n) { return std::clamp(i, 0, n - 1) / kTileSide; };
  for (int ty = tile_of(rect.y0, ny()); ty <= tile_of(rect.y1 - 1, ny()); ++ty)
    for (int tx = tile_of(rect.x0, nx()); tx <= tile_of(rect.x1 - 1, nx()); ++tx) {
      // The tiles at the edge of the site also stand for columns outside it.
      const int last_tx = (nx() - 1) / kTileSide, last_ty = (ny() - 1) / kTileSide;
      const int x0 = tx == 0 ? rect.x0 : std::max(rect.x0, tx * kTileSide);
      const int x1 = tx == last_tx ? rect.x1 : std::min(rect.x1, (tx + 1) * kTileSide);
      const int y0 = ty == 0 ? rect.y0 : std::max(rect.y0, ty * kTileSide);
      const int y1 = ty == last_ty ? rect.y1 : std::min(rect.y1, (ty + 1) * kTileSide);
      const SurfaceTile* tile = table_.find(tx, ty);
      const TileHeights& h = tile != nullptr ? tile->height : start_->passing(tx, ty, buffer);
      for (int iy = y0; iy < y1; ++iy) {
        float* row = out.data() + static_cast<std::size_t>(iy - rect.y0) * (rect.x1 - rect.x0);
        const double* from = h.data() + (std::clamp(iy, 0, ny() - 1) % kTileSide) * kTileSide;
        for (int ix = x0; ix < x1; ++ix)
          row[ix - rect.x0] = static_cast<float>(from[std::clamp(ix, 0, nx() - 1) % kTileSide]);
      }
    }
}

double Terrain::ray(const Vec3& p, const Vec3& d, double range) const {
  const double cell = this->cell();
  const auto along = [&](int axis) { return (p[axis] - origin()[axis]) / cell - 0.5; };
  const double gx = along(0), gy = along(1), dx = d.x() / cell, dy = d.y() / cell;
  int ix = static_cast<int>(bounded(std::floor(gx), -1e9, 1e9));
  int iy = static_cast<int>(bounded(std::floor(gy), -1e9, 1e9));
  if (!p.allFinite() || !d.allFinite()) return -1;
  if (p.z() <= sample(p.x(), p.y())) return 0;
  const double infinity = std::numeric_limits<double>::infinity();
  const auto exit_of = [&](double g, double dg, int i) {
    return dg > 0 ? (i + 1 - g) / dg : dg < 0 ? (i - g) / dg : infinity;
  };
  // Walks the dual cells between column centres. In each the surface is bilinear, and the height of
  // the ray above it is a quadratic in t. Cells are entered and left at the lines between column
  // centres.
  double t0 = 0;
  while (t0 < range) {
    const double tx = exit_of(gx, dx, ix), ty = exit_of(gy, dy, iy);
    const double t1 = std::min({tx, ty, range});
    double z[4];
    corners(ix, iy, z);
    const double b = z[1] - z[0], c = z[2] - z[0], e = z[3] - z[2] - b;
    const double u = gx + dx * t0 - ix, v = gy + dy * t0 - iy;
    const double f0 = p.z() + d.z() * t0 - (z[0] + b * u + c * v + e * u * v);
    const double f1 = d.z() - b * dx - c * dy - e * (u * dy + v * dx), f2 = -e * dx * dy;
    // The height above the surface is f0 + f1 t + f2 t^2, counted from the entry.
    const double hit = first_root(f0, f1, f2, t1 - t0);
    if (hit >= 0) return t0 + hit;
    // Through a corner both indices move on.
    if (tx <= ty) ix += dx > 0 ? 1 : -1;
    if (ty <= tx) iy += dy > 0 ? 1 : -1;
    t0 = std::max(t1, t0);
  }
  return -1;
}

}  // namespace navvy::heightfield
