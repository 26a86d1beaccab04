// SPDX-License-Identifier: Apache-2.0
// Soil layers of the columns that differ from the untouched site, stored in a sparse table of tiles
// of 32 x 32 columns.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "heightfield/start_site.h"
#include "heightfield/surface_table.h"

namespace navvy {
class Archive;
}

namespace navvy::heightfield {

/// Layers of the changed columns of one tile. A tile is created when one of its columns is first
/// changed.
struct Tile {
  /// Index into `columns` for each column of the tile, x fastest; -1 for a column that never
  /// changed.
  std::array<std::int16_t, kTileColumns> slot;
  /// Layers of each changed column, in the order of their first change.
  std::vector<Column> columns;
};

/// Layers of all columns that differ from the untouched site. Their visible surface is stored in a
/// SurfaceTable, which the owner updates by calling `update_surface`.
class Tiles {
 public:
  /// Makes a table for `site` in which no column has changed.
  explicit Tiles(std::shared_ptr<const StartSite> site);

  /// Returns the layers of column (ix, iy); null if the column never changed.
  const Column* find_column(int ix, int iy) const;
  /// Returns the layers of column (ix, iy) for writing. Stores its initial layers first if the
  /// column never changed. The caller must call `update_surface` after writing. @throws InputError
  /// as StartSite::column.
  Column& touch_column(int ix, int iy);
  /// Writes height, soil and density state of changed column (ix, iy) to `table`. `start` provides
  /// the initial heights for a new tile of the table.
  void update_surface(int ix, int iy, SurfaceTable& table, const StartHeights& start) const;
  /// Calls `update_surface` for all changed columns.
  void update_surfaces(SurfaceTable& table, const StartHeights& start) const;

  /// Returns the tiles that contain changed columns. The key of tile (tx, ty) is ty * tiles_x() +
  /// tx.
  const std::map<std::int64_t, std::unique_ptr<Tile>>& touched() const { return touched_; }
  /// Returns the initial mass of all columns that have changed, one entry per soil [kMassQuantum].
  const std::vector<std::int64_t>& start_mass() const { return start_mass_; }

  /// Saves or loads the layers of the changed columns, in ascending order of tile and column,
  /// regardless of the order of edits. Tiles that were created but have no changed column are saved
  /// too.
  /// @throws InputError when loading a column outside the site or an impossible layer.
  void visit(Archive& a);

  /// Returns the number of tiles of the site along x.
  int tiles_x() const { return tiles_x_; }
  /// Returns the thickness of one mass unit in a column [m], one entry per soil.
  const UnitThickness& unit() const { return site_->unit(); }

 private:
  /// Pointers to 32 x 32 neighbouring tiles; null where a tile has no changes. Groups are created
  /// on demand, so an untouched site of 1 km2 takes 800 bytes.
  using Group = std::array<Tile*, kTileColumns>;
  /// Returns the index in `groups_` of the group that contains tile (tx, ty).
  std::size_t group_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(groups_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  /// Returns tile (tx, ty); null if none of its columns changed.
  Tile* find_tile(int tx, int ty) const;
  /// Returns tile (tx, ty) and creates it if it does not exist.
  Tile& touch_tile(int tx, int ty);
  /// Makes all columns as on the untouched site again.
  void clear();

  /// The untouched site.
  std::shared_ptr<const StartSite> site_;
  /// Number of tiles and number of groups along x.
  int tiles_x_, groups_x_;
  /// Tiles with changed columns, by their key ty * tiles_x_ + tx. Snapshots and hashes contain them
  /// in the order of the keys.
  std::map<std::int64_t, std::unique_ptr<Tile>> touched_;
  /// Groups of tiles, x fastest; null where a group has no tile. Serve to find a tile without a
  /// search.
  std::vector<std::unique_ptr<Group>> groups_;
  /// Initial mass of all columns that have changed, one entry per soil [kMassQuantum].
  std::vector<std::int64_t> start_mass_;
};

}  // namespace navvy::heightfield
