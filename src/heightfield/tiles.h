// SPDX-License-Identifier: Apache-2.0
// Layers of the columns that changed: a sparse table of tiles of 32 x 32 columns over the untouched
// site.
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

/// A touched tile: the layers of those of its columns that changed.
struct Tile {
  /// Index into `columns`; -1 where the column is as on the untouched site.
  std::array<std::int16_t, kTileColumns> slot;
  /// Layers of the changed columns.
  std::vector<Column> columns;
};

/// Layers of the columns that differ from the untouched site. Their visible state is in a
/// SurfaceTable, which `update_surface` keeps consistent.
class Tiles {
 public:
  /// Makes a table without touched tiles.
  explicit Tiles(std::shared_ptr<const StartSite> site);

  /// Returns the layers of a changed column, or null while it is as at the start.
  const Column* find_column(int ix, int iy) const;
  /// Returns the column for writing and creates it if needed; call `update_surface` after changing
  /// it.
  Column& touch_column(int ix, int iy);
  /// Writes height, soil and density state of a touched column into the table.
  void update_surface(int ix, int iy, SurfaceTable& table, const StartHeights& start) const;
  /// Writes those of all touched columns.
  void update_surfaces(SurfaceTable& table, const StartHeights& start) const;

  /// Returns the touched tiles by key (ty tiles_x + tx), in ascending order.
  const std::map<std::int64_t, std::unique_ptr<Tile>>& touched() const { return touched_; }
  /// Returns the mass that the changed columns held at the start, per soil [kMassQuantum].
  const std::vector<std::int64_t>& start_mass() const { return start_mass_; }

  /// Visits the layers of the changed columns in the order of tiles and of the columns in them,
  /// independent of the order of edits. A tile without changed columns counts too, because it was
  /// touched.
  /// @throws InputError for a column outside the site or an impossible layer.
  void visit(Archive& a);

  int tiles_x() const { return tiles_x_; }
  const UnitThickness& unit() const { return site_->unit(); }

 private:
  // Groups of 32 x 32 pointers lead to the tiles, so that a site of 1 km2 costs 800 bytes until it
  // is touched.
  using Group = std::array<Tile*, kTileColumns>;
  std::size_t group_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(groups_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  /// Returns null while no column of the tile was touched.
  Tile* find_tile(int tx, int ty) const;
  /// Returns the tile and creates it if needed.
  Tile& touch_tile(int tx, int ty);
  /// Removes all changes.
  void clear();

  std::shared_ptr<const StartSite> site_;
  int tiles_x_, groups_x_;
  std::map<std::int64_t, std::unique_ptr<Tile>> touched_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<std::int64_t> start_mass_;
};

}  // namespace navvy::heightfield
