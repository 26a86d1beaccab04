// SPDX-License-Identifier: Apache-2.0
// Two views differ only in tiles that they do not share; those are compared column by column.
#include "heightfield/change_follower.h"

#include <algorithm>
#include <cstring>
#include <memory>

namespace navvy::heightfield {
namespace {

/// One tile of a view, touched or not.
class TileFace {
 public:
  TileFace(const SurfaceTile* tile, const StartHeights& start, int tx, int ty, TileHeights& buffer)
      : tile_(tile),
        site_(start.site()),
        heights_(tile != nullptr ? tile->height : start.passing(tx, ty, buffer)),
        x0_(tx * kTileSide),
        y0_(ty * kTileSide) {}

  /// Returns true when a whole row of the tile is bit-identical, which holds for most rows.
  bool same_row(const TileFace& other, int y) const {
    const auto i = static_cast<std::size_t>(y * kTileSide);
    if (tile_ == nullptr || other.tile_ == nullptr) return false;
    const auto equal = [&](const auto& a, const auto& b) {
      // Bit for bit, as a not-a-number that stays is no change.
      const void *first = &a[i], *second = &b[i];
      return std::memcmp(first, second, kTileSide * sizeof a[0]) == 0;
    };
    return equal(tile_->height, other.tile_->height) && equal(tile_->soil, other.tile_->soil) &&
           equal(tile_->specific_volume, other.tile_->specific_volume) &&
           (tile_->loose == other.tile_->loose ||
            (tile_->loose && other.tile_->loose && equal(*tile_->loose, *other.tile_->loose)));
  }
  bool same(const TileFace& other, int x, int y) const {
    const auto i = static_cast<std::size_t>(y * kTileSide + x);
    return heights_[i] == other.heights_[i] && soil(i, x, y) == other.soil(i, x, y) &&
           specific_volume(i) == other.specific_volume(i) && loose(i) == other.loose(i);
  }

 private:
  // Compares fields by value, whether stored or implied: a column that was dug and refilled with
  // the same soil has not changed.
  std::uint16_t soil(std::size_t i, int x, int y) const {
    const std::uint16_t soil = tile_ != nullptr ? tile_->soil[i] : kSoilAsAtStart;
    return soil != kSoilAsAtStart ? soil : site_.surface_soil(x0_ + x, y0_ + y);
  }
  float specific_volume(std::size_t i) const {
    return tile_ != nullptr ? tile_->specific_volume[i] : 1.0f;
  }
  float loose(std::size_t i) const {
    return tile_ != nullptr && tile_->loose ? (*tile_->loose)[i] : 0.0f;
  }

  const SurfaceTile* tile_;
  const StartSite& site_;
  const TileHeights& heights_;
  int x0_, y0_;
};

/// Adds the runs of columns that differ, row by row; the list unites equal runs of neighbouring
/// rows.
void compare(const TileFace& a, const TileFace& b, const CellRect& tile, RectList& out) {
  for (int iy = tile.y0; iy < tile.y1; ++iy) {
    if (a.same_row(b, iy - tile.y0)) continue;
    for (int ix = tile.x0; ix < tile.x1;) {
      if (a.same(b, ix - tile.x0, iy - tile.y0)) {
        ++ix;
        continue;
      }
      // Extends to the end of the run.
      const int first = ix;
      while (ix < tile.x1 && !a.same(b, ix - tile.x0, iy - tile.y0)) ++ix;
      out.add({first, iy, ix, iy + 1});
    }
  }
}

}  // namespace

// Squares, tiles, rows and columns are compared in this order, so that equal parts cost one
// comparison each.
std::vector<CellRect> ChangeFollower::take(const TerrainView& view) {
  RectList out;
  // Grounds of one site share its description; another description means another initial surface.
  const bool same_site = seen_ && seen_->start_->shared_site() == view.start_->shared_site();
  if (!same_site) {
    out.add(view.site_rect());
    seen_ = view;
    return out.rects();
  }
  // Views share tiles until they are written: equal pointers mean equal columns, and a whole square
  // of 1024 tiles is skipped at once.
  const SurfaceTable &old = seen_->table_, &now = view.table_;
  TileHeights buffer;
  for (std::size_t s = 0; s < now.squares(); ++s) {
    if (old.square(s) == now.square(s)) continue;
    const int tx1 = std::min(now.first_tx(s) + kTileSide, now.tiles_x());
    const int ty1 = std::min(now.first_ty(s) + kTileSide, now.tiles_y());
    for (int ty = now.first_ty(s); ty < ty1; ++ty)
      for (int tx = now.first_tx(s); tx < tx1; ++tx) {
        const SurfaceTile *before = old.find(tx, ty), *after = now.find(tx, ty);
        if (before == after) continue;
        const CellRect tile{tx * kTileSide, ty * kTileSide, (tx + 1) * kTileSide,
                            (ty + 1) * kTileSide};
        // At most one of the two is untouched, so one buffer suffices.
        compare({before, *view.start_, tx, ty, buffer}, {after, *view.start_, tx, ty, buffer},
                tile.cut(view.site_rect()), out);
      }
  }
  seen_ = view;
  return out.rects();
}

}  // namespace navvy::heightfield
