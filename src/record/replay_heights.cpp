// SPDX-License-Identifier: Apache-2.0
#include "record/replay_heights.h"

#include <algorithm>
#include <cmath>

namespace navvy::record {
namespace {

constexpr int kLargest = 30000;  // numbers at the start; spoil and pits take more

/// Returns the window of at most ReplayHeights::kMost columns about `middle`.
heightfield::CellRect window_about(const heightfield::Terrain& site, const Vec2& middle) {
  const int nx = std::min(site.nx(), ReplayHeights::kMost),
            ny = std::min(site.ny(), ReplayHeights::kMost);
  const Vec2 at = (middle - site.origin()) / site.cell();
  const int x0 = std::clamp(static_cast<int>(std::floor(at.x())) - nx / 2, 0, site.nx() - nx),
            y0 = std::clamp(static_cast<int>(std::floor(at.y())) - ny / 2, 0, site.ny() - ny);
  return {x0, y0, x0 + nx, y0 + ny};
}

}  // namespace

ReplayHeights::ReplayHeights(const heightfield::Terrain& site, const Vec2& middle)
    : window_(window_about(site, middle)) {
  double low = site.start_height(window_.x0, window_.y0), high = low;
  for (int iy = window_.y0; iy < window_.y1; ++iy)
    for (int ix = window_.x0; ix < window_.x1; ++ix) {
      low = std::min(low, site.start_height(ix, iy));
      high = std::max(high, site.start_height(ix, iy));
    }
  base_ = 0.5 * (low + high);
  unit_ = std::max(1e-3, 0.5 * (high - low) / kLargest);
  numbers_.reserve(static_cast<std::size_t>(window_.x1 - window_.x0) *
                   static_cast<std::size_t>(window_.y1 - window_.y0));
  for (int iy = window_.y0; iy < window_.y1; ++iy)
    for (int ix = window_.x0; ix < window_.x1; ++ix)
      numbers_.push_back(number(site.start_height(ix, iy)));
}

std::int16_t ReplayHeights::number(double z) const {
  // The lowest number means that there is no height.
  const double rounded = std::round((z - base_) / unit_);
  return static_cast<std::int16_t>(std::clamp(rounded, kNone + 1.0, double{INT16_MAX}));
}

std::vector<std::int16_t> ReplayHeights::numbers_of(
    const heightfield::DesignSurface& design) const {
  std::vector<std::int16_t> out;
  out.reserve(numbers_.size());
  for (int iy = window_.y0; iy < window_.y1; ++iy)
    for (int ix = window_.x0; ix < window_.x1; ++ix) {
      const float z = design.rect.contains(ix, iy) ? design.at(ix, iy) : NAN;
      out.push_back(std::isfinite(z) ? number(static_cast<double>(z)) : kNone);
    }
  return out;
}

std::vector<std::int16_t> ReplayHeights::take(const heightfield::TerrainView& view, bool all) {
  const int nx = window_.x1 - window_.x0;
  std::set<std::pair<int, int>> changed;
  for (const heightfield::CellRect& rect : changes_.take(view)) {
    const heightfield::CellRect in = rect.cut(window_);
    if (in.empty()) continue;
    for (int iy = in.y0; iy < in.y1; ++iy)
      for (int ix = in.x0; ix < in.x1; ++ix) {
        const int x = ix - window_.x0, y = iy - window_.y0;
        std::int16_t& old = numbers_[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) +
                                     static_cast<std::size_t>(x)];
        const std::int16_t now = number(view.height(ix, iy));
        if (now == old) continue;
        old = now;
        changed.emplace(y / kTile, x / kTile);
      }
  }
  touched_.insert(changed.begin(), changed.end());
  std::vector<std::int16_t> out;
  for (const auto& [ty, tx] : all ? touched_ : changed) append_tile(tx, ty, out);
  return out;
}

void ReplayHeights::append_tile(int tx, int ty, std::vector<std::int16_t>& out) const {
  const int nx = window_.x1 - window_.x0, ny = window_.y1 - window_.y0;
  out.push_back(static_cast<std::int16_t>(tx));
  out.push_back(static_cast<std::int16_t>(ty));
  for (int y = ty * kTile; y < (ty + 1) * kTile; ++y)
    for (int x = tx * kTile; x < (tx + 1) * kTile; ++x)
      out.push_back(x < nx && y < ny
                        ? numbers_[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) +
                                   static_cast<std::size_t>(x)]
                        : std::int16_t{0});
}

}  // namespace navvy::record
