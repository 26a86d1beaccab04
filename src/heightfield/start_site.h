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

/// Number of columns along each side of a tile, the unit in which columns are stored and shared.
inline constexpr int kTileSide = 32;
/// Number of columns in a tile.
inline constexpr int kTileColumns = kTileSide * kTileSide;
/// Returns the index of column (ix, iy) within its tile, x fastest.
inline int index_in_tile(int ix, int iy) { return (iy % kTileSide) * kTileSide + ix % kTileSide; }

/// Heights of the 1024 columns of a tile, as world z [m], x fastest. Columns beyond the edge of the
/// site repeat the last column inside it.
using TileHeights = std::array<double, kTileColumns>;

/// The columns of the untouched site as a pure function of their indices. Immutable, so several
/// threads may read it.
class StartSite {
 public:
  /// Makes the site of `setup`, which must be valid. (The constructor of Ground checks it.)
  explicit StartSite(GroundSetup setup);

  /// Returns the description of the site.
  const GroundSetup& setup() const { return setup_; }
  /// Returns the thickness of one mass unit in a column [m], one entry per soil.
  const UnitThickness& unit() const { return unit_; }
  /// Returns the number of tiles along x. The last one may extend beyond the site.
  int tiles_x() const { return (setup_.nx + kTileSide - 1) / kTileSide; }
  /// Returns the number of tiles along y. The last one may extend beyond the site.
  int tiles_y() const { return (setup_.ny + kTileSide - 1) / kTileSide; }

  /// Computes the initial layers of site column (ix, iy) and writes them to `out`, from bottom to
  /// top.
  /// @throws InputError if the surface source returns a height that is not finite.
  void column(int ix, int iy, Column& out) const;
  /// Returns the initial height of site column (ix, iy), as world z [m]. Each call evaluates the
  /// surface source. @throws InputError as `column`.
  double height(int ix, int iy) const;
  /// Computes the initial heights of all columns of tile (tx, ty) and writes them to `out`.
  /// Evaluates the surface source up to 1024 times. @throws InputError as `column`.
  void heights(int tx, int ty, TileHeights& out) const;
  /// Returns the index of the uppermost soil of column (ix, iy): that of the first layer in the
  /// column's description with a thickness above 0, or of the last layer if there is none. A column
  /// without soil above bedrock has an index too.
  std::uint16_t surface_soil(int ix, int iy) const;

 private:
  /// One soil layer of a Stack.
  struct StackLayer {
    /// Index of the layer's soil in the setup's list of soils.
    std::uint16_t soil;
    /// Thickness of the layer [m].
    double thickness;
  };
  /// Layers of a column as the scene describes them, from the surface downwards. The last layer
  /// reaches down to bedrock.
  using Stack = std::vector<StackLayer>;
  /// A rectangle of the site whose layers differ from those of the rest.
  struct Patch {
    /// Corners of the rectangle, (x0, y0) and (x1, y1), as world positions [m].
    double x0, y0, x1, y1;
    /// Layers of the columns in the rectangle, from the surface downwards.
    Stack stack;
  };
  /// Converts layers of a scene to a Stack, replacing soil names by indices.
  Stack make_stack(const std::vector<scene::GroundLayer>& layers) const;
  /// Returns the description of column (ix, iy): that of the last patch that contains its centre,
  /// or else that of the site.
  const Stack& stack_at(int ix, int iy) const;

  /// Description of the site.
  GroundSetup setup_;
  /// Thickness of one mass unit [m], one entry per soil.
  UnitThickness unit_;
  /// Layers outside all patches.
  Stack stack_;
  /// Patches in the order of the scene. Later ones take precedence over earlier ones.
  std::vector<Patch> patches_;
};

/// Cache of the initial heights of a site, tile by tile.
///
/// Any number of threads may read at the same time. The first reader of a tile computes it; after
/// that the tile never changes or moves. At most kMostTiles tiles (16 MiB) are cached. The columns
/// of all other tiles are computed one by one at every query, until the owner replaces the cache
/// because `worn` returns true.
class StartHeights {
 public:
  /// Maximum number of cached tiles.
  static constexpr int kMostTiles = 2048;

  /// Makes an empty cache of the initial heights of `site`.
  explicit StartHeights(std::shared_ptr<const StartSite> site);
  /// Deletes the cached tiles. No thread may read them any more.
  ~StartHeights();
  StartHeights(const StartHeights&) = delete;
  StartHeights& operator=(const StartHeights&) = delete;

  /// Returns the site whose heights are cached.
  const StartSite& site() const { return *site_; }
  /// Returns the shared pointer to the site. Grounds and views of the same site have equal
  /// pointers.
  const std::shared_ptr<const StartSite>& shared_site() const { return site_; }

  /// Returns the initial height of site column (ix, iy), as world z [m].
  double height(int ix, int iy) const {
    const TileHeights* heights = tile(ix / kTileSide, iy / kTileSide);
    return heights != nullptr ? (*heights)[static_cast<std::size_t>(index_in_tile(ix, iy))]
                              : single(ix, iy);
  }
  /// Returns the initial heights of tile (tx, ty). Computes and caches them on the first call;
  /// returns null if the cache is full and does not contain the tile.
  const TileHeights* tile(int tx, int ty) const {
    const Group* group = groups_[group_of(tx, ty)].load(std::memory_order_acquire);
    const TileHeights* heights =
        group == nullptr ? nullptr
                         : group->at(tile_in_group(tx, ty)).load(std::memory_order_acquire);
    return heights != nullptr ? heights : fill(tx, ty);
  }
  /// Returns the initial heights of tile (tx, ty) without adding the tile to the cache. A tile that
  /// is not cached is computed into `buffer`, and the result refers to `buffer`. Meant for passes
  /// over the whole site.
  const TileHeights& passing(int tx, int ty, TileHeights& buffer) const;

  /// Returns true if so many column heights were computed one by one that replacing the cache by an
  /// empty one saves time. The threshold is one eighth of the columns that the cache can hold.
  bool worn() const {
    return computed_.load(std::memory_order_relaxed) > kMostTiles / 8 * kTileColumns;
  }

 private:
  /// Pointers to 32 x 32 neighbouring tiles; null where a tile is not cached. Groups are created on
  /// demand, so a site of 1 km2 takes 800 bytes before it is read.
  using Group = std::array<std::atomic<const TileHeights*>, kTileColumns>;
  /// Returns the index in `groups_` of the group that contains tile (tx, ty).
  std::size_t group_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(groups_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  /// Returns the index of tile (tx, ty) within its group.
  static std::size_t tile_in_group(int tx, int ty) {
    return static_cast<std::size_t>(index_in_tile(tx, ty));
  }
  /// Computes tile (tx, ty), caches it and returns it. Returns null if the cache is full, and the
  /// tile of another thread if that thread cached it first.
  const TileHeights* fill(int tx, int ty) const;
  /// Computes the initial height of column (ix, iy), whose tile is not cached, as world z [m].
  /// Increments the count of such queries, which `worn` compares with its threshold.
  double single(int ix, int iy) const;

  /// Site whose heights are cached.
  std::shared_ptr<const StartSite> site_;
  /// Number of groups of tiles along x.
  int groups_x_;
  /// Groups of tiles, x fastest; null where no tile of a group is cached. Const functions fill them
  /// in, so entries are atomic, and do not change once they are set.
  mutable std::vector<std::atomic<Group*>> groups_;
  /// Number of cached tiles.
  mutable std::atomic<int> tiles_{0};
  /// Number of column heights that were computed one by one because their tile is not cached.
  mutable std::atomic<std::int64_t> computed_{0};
};

}  // namespace navvy::heightfield
