// SPDX-License-Identifier: Apache-2.0
// The untouched site: what every column was at the start, computed on demand.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "heightfield/column.h"
#include "heightfield/ground_setup.h"

namespace navvy::heightfield {

/// Columns are kept and shared in squares of 32 x 32.
inline constexpr int kTileSide = 32;
inline constexpr int kTileColumns = kTileSide * kTileSide;
/// Place of a column in its tile, x fastest.
inline int index_in_tile(int ix, int iy) { return (iy % kTileSide) * kTileSide + ix % kTileSide; }

/// Heights [m] in W of the 1024 columns of a tile, x fastest. Columns beyond the site's edge repeat
/// the last one inside.
using TileHeights = std::array<double, kTileColumns>;

/// Columns of the untouched site as a pure function of place. Immutable; several threads may read
/// it.
class StartSite {
 public:
  /// The setup must be a checked one, see Ground.
  explicit StartSite(GroundSetup setup);

  const GroundSetup& setup() const { return setup_; }
  /// Metres of thickness that one mass unit makes, by soil.
  const UnitThickness& unit() const { return unit_; }
  /// Tiles along x and y; the last ones may reach beyond the site.
  int tiles_x() const { return (setup_.nx + kTileSide - 1) / kTileSide; }
  int tiles_y() const { return (setup_.ny + kTileSide - 1) / kTileSide; }

  /// Layers of column (ix, iy) of the site, bottom first. @throws InputError where the source is
  /// not finite.
  void column(int ix, int iy, Column& out) const;
  /// Surface in W [m]; costs a call of the source. @throws like `column`.
  double height(int ix, int iy) const;
  /// All heights of tile (tx, ty); 1024 calls of the source.
  void heights(int tx, int ty, TileHeights& out) const;
  /// Index of the uppermost soil; where there is bedrock only, of the soil that would lie there.
  std::uint16_t surface_soil(int ix, int iy) const;

 private:
  struct StackLayer {
    std::uint16_t soil;
    double thickness;  // [m]
  };
  // A description of a column: how thick each soil is.
  using Stack = std::vector<StackLayer>;  // from the surface down
  // A rectangle [m] in W with another stack than the rest of the site.
  struct Patch {
    double x0, y0, x1, y1;
    Stack stack;
  };
  /// Soils by index instead of name.
  Stack make_stack(const std::vector<scene::GroundLayer>& layers) const;
  /// The description that holds for a column.
  const Stack& stack_at(int ix, int iy) const;

  GroundSetup setup_;
  UnitThickness unit_;
  Stack stack_;
  std::vector<Patch> patches_;
};

/// Heights of the untouched site, remembered by tile.
///
/// Any number of threads may read at a time: a tile is computed by who asks first and then never
/// changes or moves. At most kMostTiles (16 MiB) are remembered; other columns are computed one by
/// one at every question, until the owner replaces a table that is `worn`.
class StartHeights {
 public:
  static constexpr int kMostTiles = 2048;

  /// Nothing is computed until it is asked for.
  explicit StartHeights(std::shared_ptr<const StartSite> site);
  ~StartHeights();
  StartHeights(const StartHeights&) = delete;
  StartHeights& operator=(const StartHeights&) = delete;

  /// Where the heights come from. Views and grounds of one site share it, which tells that they
  /// belong together.
  const StartSite& site() const { return *site_; }
  const std::shared_ptr<const StartSite>& shared_site() const { return site_; }

  /// Height of column (ix, iy) of the site [m].
  double height(int ix, int iy) const {
    const TileHeights* heights = tile(ix / kTileSide, iy / kTileSide);
    return heights != nullptr ? (*heights)[static_cast<std::size_t>(index_in_tile(ix, iy))]
                              : single(ix, iy);
  }
  /// The remembered heights of a tile, filled in now if there is room; null when there is none.
  const TileHeights* tile(int tx, int ty) const {
    const Group* group = groups_[group_of(tx, ty)].load(std::memory_order_acquire);
    const TileHeights* heights =
        group == nullptr ? nullptr
                         : group->at(tile_in_group(tx, ty)).load(std::memory_order_acquire);
    return heights != nullptr ? heights : fill(tx, ty);
  }
  /// Heights of a tile for a pass over the whole site: what is not remembered goes to `buffer` and
  /// is not kept.
  const TileHeights& passing(int tx, int ty, TileHeights& buffer) const;

  /// So many columns had to be computed one by one that a new table pays: about as many as it can
  /// hold an eighth of.
  bool worn() const {
    return computed_.load(std::memory_order_relaxed) > kMostTiles / 8 * kTileColumns;
  }

 private:
  // Tiles are found through groups of 32 x 32 pointers, so a 1 km2 site costs 800 bytes until it is
  // read.
  using Group = std::array<std::atomic<const TileHeights*>, kTileColumns>;
  std::size_t group_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(groups_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  static std::size_t tile_in_group(int tx, int ty) {
    return static_cast<std::size_t>(index_in_tile(tx, ty));
  }
  /// Computes a tile and puts it in its place, unless the table is full (null) or another thread
  /// was faster (theirs).
  const TileHeights* fill(int tx, int ty) const;
  /// Computes one column that is not remembered.
  double single(int ix, int iy) const;

  std::shared_ptr<const StartSite> site_;
  int groups_x_;
  // Filled in by const calls: atomic, and never changed once set.
  mutable std::vector<std::atomic<Group*>> groups_;
  mutable std::atomic<int> tiles_{0};
  mutable std::atomic<std::int64_t> computed_{0};
};

}  // namespace navvy::heightfield
