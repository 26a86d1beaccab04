// SPDX-License-Identifier: Apache-2.0
// Where the layers of changed columns are kept: a sparse table of 32 x 32 tiles over the untouched
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

/// A tile that was touched: layers of those of its columns that were changed.
struct Tile {
  std::array<std::int16_t, kTileColumns> slot;  ///< into `columns`; -1: as in the untouched site
  std::vector<Column> columns;
};

/// Layers of the columns that differ from the untouched site. What can be seen of them stands in a
/// SurfaceTable, which `update_surface` keeps in step.
class Tiles {
 public:
  /// None touched yet.
  explicit Tiles(std::shared_ptr<const StartSite> site);

  /// Layers of a changed column, or null while it is as at the start.
  const Column* find_column(int ix, int iy) const;
  /// The column, brought into being; call `update_surface` after changing it.
  Column& touch_column(int ix, int iy);
  /// Writes height, soil and density state of a touched column into the table.
  void update_surface(int ix, int iy, SurfaceTable& table, const StartHeights& start) const;
  /// The same for all touched columns.
  void update_surfaces(SurfaceTable& table, const StartHeights& start) const;

  /// Touched tiles by key (ty tiles_x + tx), in rising order.
  const std::map<std::int64_t, std::unique_ptr<Tile>>& touched() const { return touched_; }
  /// Mass that the changed columns held at the start, per soil.
  const std::vector<std::int64_t>& start_mass() const { return start_mass_; }

  /// Layers of the changed columns, in the order of tiles and of columns within them, not of the
  /// edits that brought them into being. A tile without changed columns counts too: it was touched.
  /// @throws InputError for a column outside the site or a layer that is not soil.
  void visit(Archive& a);

  int tiles_x() const { return tiles_x_; }
  const UnitThickness& unit() const { return site_->unit(); }

 private:
  // Tiles are found through groups of 32 x 32 pointers, so a 1 km2 site costs 800 bytes until it is
  // touched.
  using Group = std::array<Tile*, kTileColumns>;
  std::size_t group_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(groups_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  /// Null while no column of it was touched.
  Tile* find_tile(int tx, int ty) const;
  Tile& touch_tile(int tx, int ty);
  /// Forgets all changes.
  void clear();

  std::shared_ptr<const StartSite> site_;
  int tiles_x_, groups_x_;
  std::map<std::int64_t, std::unique_ptr<Tile>> touched_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<std::int64_t> start_mass_;
};

}  // namespace navvy::heightfield
