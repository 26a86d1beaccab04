// SPDX-License-Identifier: Apache-2.0
#include "sensor/ground_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navvy::sensor {

using heightfield::CellRect;

void GroundRays::update(const heightfield::TerrainView& surface) {
  surface_.emplace(surface);
  const int nx = (surface.nx() + kTile - 1) / kTile, ny = (surface.ny() + kTile - 1) / kTile;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (nx != nx_ || ny != ny_) {
    nx_ = nx;
    ny_ = ny;
    highest_.assign(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), unknown);
  }
  for (const CellRect& rect : changes_.take(surface)) {
    // A tile's highest point includes the columns around it, to which its surface leads.
    const int x0 = std::max(0, (rect.x0 - 1) / kTile), x1 = std::min(nx_ - 1, rect.x1 / kTile);
    const int y0 = std::max(0, (rect.y0 - 1) / kTile), y1 = std::min(ny_ - 1, rect.y1 / kTile);
    for (int ty = y0; ty <= y1; ++ty)
      for (int tx = x0; tx <= x1; ++tx) highest_[static_cast<std::size_t>(tx + nx_ * ty)] = unknown;
  }
}

double GroundRays::highest(int tx, int ty) const {
  double& known = highest_[static_cast<std::size_t>(tx + nx_ * ty)];
  if (std::isnan(known)) {
    const CellRect whole{0, 0, surface_->nx(), surface_->ny()};
    const CellRect tile{tx * kTile - 1, ty * kTile - 1, (tx + 1) * kTile + 1, (ty + 1) * kTile + 1};
    known = surface_->highest(tile.cut(whole));
  }
  return known;
}

std::optional<double> GroundRays::first_hit(const Vec3& p_W, const Vec3& direction_W,
                                            double reach) const {
  const heightfield::TerrainView& ground = *surface_;
  const double edge = kTile * ground.cell();
  const Vec2 low = ground.origin();
  const Vec2 high = low + ground.cell() * Vec2(ground.nx(), ground.ny());
  // Where the beam is above the site.
  double t0 = 0, t1 = reach;
  for (int k = 0; k < 2; ++k) {
    if (direction_W[k] == 0) {
      if (p_W[k] < low[k] || p_W[k] > high[k]) return std::nullopt;
      continue;
    }
    const double a = (low[k] - p_W[k]) / direction_W[k], b = (high[k] - p_W[k]) / direction_W[k];
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  if (t0 > t1) return std::nullopt;
  const auto tile_of = [&](int k, int n) {
    const double at = (p_W[k] + t0 * direction_W[k] - low[k]) / edge;
    return std::clamp(static_cast<int>(std::floor(at)), 0, n - 1);
  };
  int cell[2] = {tile_of(0, nx_), tile_of(1, ny_)}, step[2];
  double next[2];
  for (int k = 0; k < 2; ++k) {
    step[k] = direction_W[k] > 0 ? 1 : -1;
    next[k] = direction_W[k] == 0
                  ? std::numeric_limits<double>::infinity()
                  : (low[k] + edge * (cell[k] + (step[k] > 0 ? 1 : 0)) - p_W[k]) / direction_W[k];
  }
  // Runs of tiles that the beam may touch are walked column by column, in one piece.
  double from = -1;
  const auto walk = [&](double until) -> std::optional<double> {
    const double t = ground.ray(p_W + from * direction_W, direction_W, until - from);
    return t < 0 ? std::nullopt : std::optional<double>(from + t);
  };
  for (double t = t0; t < t1;) {
    const int axis = next[0] <= next[1] ? 0 : 1;
    const double leaves = std::min(next[axis], t1);
    const double lowest = p_W.z() + direction_W.z() * (direction_W.z() < 0 ? leaves : t);
    const bool near = lowest <= highest(cell[0], cell[1]);
    if (near && from < 0) from = t;
    if (!near && from >= 0) {
      if (const auto hit = walk(t)) return hit;
      from = -1;
    }
    t = leaves;
    cell[axis] += step[axis];
    next[axis] += edge * std::abs(1 / direction_W[axis]);
    if (cell[axis] < 0 || cell[axis] >= (axis == 0 ? nx_ : ny_)) break;
  }
  return from < 0 ? std::nullopt : walk(t1);
}

}  // namespace navvy::sensor
