// SPDX-License-Identifier: Apache-2.0
// The untouched site: the initial state of every column, computed on demand.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "heightfield/column.h"
#include "heightfield/ground_setup.h"

namespace navvy::heightfield {

/// Columns are stored and shared in tiles of 32 x 32.
inline constexpr int kTileSide = 32;
inline constexpr int kTileColumns = kTileSide * kTileSide;
/// Returns the place of a column in its tile, x fastest.
inline int index_in_tile(int ix, int iy) { return (iy % kTileSide) * kTileSide + ix % kTileSide; }

/// Heights [m] in W of the 1024 columns of a tile, x fastest. Columns beyond the edge of the site
/// repeat the last one inside.
using TileHeights = std::array<double, kTileColumns>;

/// Columns of the untouched site as a pure function of place. Immutable; several threads may read
/// it.
class StartSite {
 public:
  /// Takes a setup that was checked as Ground does.
  explicit StartSite(GroundSetup setup);

  /// Returns the setup.
  const GroundSetup& setup() const { return setup_; }
  /// Returns the thickness [m] of one mass unit, by soil.
  const UnitThickness& unit() const { return unit_; }
  /// Returns the number of tiles along x and y; the last ones may reach beyond the site.
  int tiles_x() const { return (setup_.nx + kTileSide - 1) / kTileSide; }
  int tiles_y() const { return (setup_.ny + kTileSide - 1) / kTileSide; }

  /// Computes the layers of column (ix, iy) of the site, bottom first.
  /// @throws InputError where the source is not finite.
  void column(int ix, int iy, Column& out) const;
  /// Returns the height of the surface in W [m]; costs a call of the source. @throws as `column`.
  double height(int ix, int iy) const;
  /// Computes all heights of tile (tx, ty) with 1024 calls of the source.
  void heights(int tx, int ty, TileHeights& out) const;
  /// Returns the index of the uppermost soil; where there is bedrock only, the soil that the
  /// description names first.
  std::uint16_t surface_soil(int ix, int iy) const;

 private:
  // One soil of a stack.
  struct StackLayer {
    std::uint16_t soil;
    double thickness;  // [m]
  };
  // Description of a column from the surface down: the thickness of each soil.
  using Stack = std::vector<StackLayer>;
  // A rectangle in W [m] with another stack than the rest of the site.
  struct Patch {
    double x0, y0, x1, y1;
    Stack stack;
  };
  /// Replaces the names of soils by their indices.
  Stack make_stack(const std::vector<scene::GroundLayer>& layers) const;
  /// Returns the description of a column.
  const Stack& stack_at(int ix, int iy) const;

  GroundSetup setup_;
  UnitThickness unit_;
  Stack stack_;
  std::vector<Patch> patches_;
};

/// Heights of the untouched site, cached by tile.
///
/// Any number of threads may read at a time: the first reader of a tile computes it, and then it
/// never changes or moves. At most kMostTiles (16 MiB) are cached. All other columns are computed
/// one by one at every query, until the owner replaces a table that is `worn`.
class StartHeights {
 public:
  /// Largest number of cached tiles.
  static constexpr int kMostTiles = 2048;

  /// Makes an empty table; nothing is computed until it is asked for.
  explicit StartHeights(std::shared_ptr<const StartSite> site);
  ~StartHeights();
  StartHeights(const StartHeights&) = delete;
  StartHeights& operator=(const StartHeights&) = delete;

  /// Returns the source of the heights. Views and grounds of one site share it, which shows that
  /// they belong together.
  const StartSite& site() const { return *site_; }
  const std::shared_ptr<const StartSite>& shared_site() const { return site_; }

  /// Returns the height of column (ix, iy) of the site in W [m].
  double height(int ix, int iy) const {
    const TileHeights* heights = tile(ix / kTileSide, iy / kTileSide);
    return heights != nullptr ? (*heights)[static_cast<std::size_t>(index_in_tile(ix, iy))]
                              : single(ix, iy);
  }
  /// Returns the cached heights of a tile and computes them now if there is space; null when there
  /// is none.
  const TileHeights* tile(int tx, int ty) const {
    const Group* group = groups_[group_of(tx, ty)].load(std::memory_order_acquire);
    const TileHeights* heights =
        group == nullptr ? nullptr
                         : group->at(tile_in_group(tx, ty)).load(std::memory_order_acquire);
    return heights != nullptr ? heights : fill(tx, ty);
  }
  /// Returns the heights of a tile for a pass over the whole site. A tile that is not cached is
  /// computed into `buffer` and not kept.
  const TileHeights& passing(int tx, int ty, TileHeights& buffer) const;

  /// Returns true when so many columns were computed one by one that a new table pays: about an
  /// eighth of what a table can hold.
  bool worn() const {
    return computed_.load(std::memory_order_relaxed) > kMostTiles / 8 * kTileColumns;
  }

 private:
  // Groups of 32 x 32 pointers lead to the tiles, so that a site of 1 km2 costs 800 bytes until it
  // is read.
  using Group = std::array<std::atomic<const TileHeights*>, kTileColumns>;
  std::size_t group_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(groups_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  static std::size_t tile_in_group(int tx, int ty) {
    return static_cast<std::size_t>(index_in_tile(tx, ty));
  }
  /// Computes a tile and stores it. Returns null when the table is full, and the other tile when
  /// another thread was faster.
  const TileHeights* fill(int tx, int ty) const;
  /// Computes one column that is not cached.
  double single(int ix, int iy) const;

  std::shared_ptr<const StartSite> site_;
  int groups_x_;
  // Filled in by const calls: atomic, and never changed once set.
  mutable std::vector<std::atomic<Group*>> groups_;
  mutable std::atomic<int> tiles_{0};
  mutable std::atomic<std::int64_t> computed_{0};
};

}  // namespace navvy::heightfield
