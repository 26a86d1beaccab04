// SPDX-License-Identifier: Apache-2.0
// Heights of the ground as whole numbers, and the tiles of them that change.
#pragma once

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "heightfield/change_follower.h"
#include "heightfield/design_surface.h"
#include "heightfield/terrain_view.h"

namespace navvy::record {

/// Heights of a site as 16-bit numbers, in tiles of kTile x kTile columns.
///
/// A site of more than kMost columns along a side is followed within a window of that size. Heights
/// are in units of `unit()` from `base()`: millimetres unless the relief is more than 60 m.
class ReplayHeights {
 public:
  /// Columns along the side of a tile, and at most along the side of the window.
  static constexpr int kTile = 16, kMost = 2048;
  /// Number for a column without a height.
  static constexpr std::int16_t kNone = INT16_MIN;

  /// Reads the heights that `site` had at the start. `middle` is the point in W around which a
  /// window lies [m].
  ReplayHeights(const heightfield::Terrain& site, const Vec2& middle);

  /// Returns the columns that are followed.
  const heightfield::CellRect& window() const { return window_; }
  /// Returns the height of number 0 in W [m].
  double base() const { return base_; }
  /// Returns the difference of heights whose numbers differ by 1 [m].
  double unit() const { return unit_; }
  /// Returns the numbers of all followed columns, as of the last call of `take`, x fastest.
  const std::vector<std::int16_t>& numbers() const { return numbers_; }
  /// Returns the numbers of a design surface in all followed columns; kNone where it has none.
  std::vector<std::int16_t> numbers_of(const heightfield::DesignSurface& design) const;

  /// Takes the heights of `view`. Returns each tile that differs since the last call, at first
  /// since the start, or with `all`, each that ever did: its numbers along x and y, then the
  /// numbers of its columns, x fastest, 0 beyond the window.
  std::vector<std::int16_t> take(const heightfield::TerrainView& view, bool all);

 private:
  std::int16_t number(double z) const;
  void append_tile(int tx, int ty, std::vector<std::int16_t>& out) const;

  heightfield::CellRect window_;
  double base_ = 0, unit_ = 1e-3;
  std::vector<std::int16_t> numbers_;
  /// Tiles that have ever changed, as (y, x).
  std::set<std::pair<int, int>> touched_;
  heightfield::ChangeFollower changes_;
};

}  // namespace navvy::record
