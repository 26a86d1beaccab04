// SPDX-License-Identifier: Apache-2.0
// Surface of the tiles that differ from the untouched site. A live ground and its views share it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "heightfield/start_site.h"

namespace navvy::heightfield {

/// Value in SurfaceTile::soil of a column whose surface soil is the one it had initially.
inline constexpr std::uint16_t kSoilAsAtStart = 0xFFFF;

/// Surface of the 1024 columns of a tile, x fastest.
struct SurfaceTile {
  /// Height of the surface, including loose soil if the table has any, as world z [m].
  TileHeights height;
  /// Index of the uppermost soil of each column, or kSoilAsAtStart.
  std::array<std::uint16_t, kTileColumns> soil;
  /// Volume divided by bank volume of the uppermost soil of each column [-].
  std::array<float, kTileColumns> specific_volume;
  /// Initial height of each column, as world z [m]; never null.
  std::shared_ptr<const TileHeights> start;
  /// Depth of loose soil on each column [m]; null if the tile has none.
  std::shared_ptr<std::array<float, kTileColumns>> loose;
  /// True if copies of the table share this tile, so that it must not be written. Only the writing
  /// thread reads or sets this flag.
  bool frozen = false;
};

/// A sparse table of surface tiles that is cheap to copy. Copies share their tiles; a writer first
/// replaces a shared tile by a copy of its own (14 KiB). Copying the table takes 1.6 kB per km2 of
/// 0.1 m columns, regardless of the number of changed tiles.
///
/// Only one thread may write to a table. Copies made after `freeze` may be read by any thread, even
/// while the original is being written.
class SurfaceTable {
 public:
  /// Makes an empty table, in which all of `site` is untouched.
  explicit SurfaceTable(const StartSite& site);

  /// Returns tile (tx, ty); null if none of its columns ever changed.
  const SurfaceTile* find(int tx, int ty) const {
    const Square* square = squares_[square_of(tx, ty)].get();
    return square != nullptr ? square->tiles[static_cast<std::size_t>(index_in_tile(tx, ty))].get()
                             : nullptr;
  }
  /// Returns tile (tx, ty) for writing. Replaces a shared tile by a copy. Creates a missing tile
  /// from the initial heights `start`. @throws InputError as StartSite::column.
  SurfaceTile& own(int tx, int ty, const StartHeights& start);
  /// Marks all tiles as shared, so that later writes to this table copy them first. Must be called
  /// before the table is copied for other readers. Takes time in proportion to the number of tiles
  /// written since the last call.
  void freeze() const;
  /// Removes all tiles, which makes the site untouched again. Copies of the table keep their tiles.
  void clear();

  /// Returns the number of squares of 32 x 32 tiles. Squares serve to compare two tables of one
  /// site: their tiles are identical in square `s` if `square(s)` returns the same pointer for
  /// both.
  std::size_t squares() const { return squares_.size(); }
  /// Returns a pointer that identifies the contents of square number `s`; null if its tiles are
  /// untouched. It must not be dereferenced.
  const void* square(std::size_t s) const { return squares_[s].get(); }
  /// Returns the tile index tx of the first tile of square `s`.
  int first_tx(std::size_t s) const { return static_cast<int>(s) % squares_x_ * kTileSide; }
  /// Returns the tile index ty of the first tile of square `s`.
  int first_ty(std::size_t s) const { return static_cast<int>(s) / squares_x_ * kTileSide; }
  /// Returns the number of tiles of the site along x.
  int tiles_x() const { return tiles_x_; }
  /// Returns the number of tiles of the site along y.
  int tiles_y() const { return tiles_y_; }

 private:
  /// Pointers to 32 x 32 neighbouring tiles. Copies of the table share squares as they share tiles,
  /// so copying the table copies only one pointer per 1024 tiles.
  struct Square {
    /// Tiles of the square, x fastest; null where a tile is untouched.
    std::array<std::shared_ptr<SurfaceTile>, kTileColumns> tiles;
    /// True if copies of the table share this square.
    bool frozen = false;
  };
  /// Indices of a tile along x and y.
  struct Place {
    int tx, ty;
  };
  /// Returns the index of the square that contains tile (tx, ty).
  std::size_t square_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(squares_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  /// Number of tiles along x and y, and number of squares along x.
  int tiles_x_, tiles_y_, squares_x_;
  /// Squares of the site, in rows along x; null where all tiles of a square are untouched.
  std::vector<std::shared_ptr<Square>> squares_;
  /// Tiles written since the last call of `freeze`, which only this table uses.
  mutable std::vector<Place> written_;
};

}  // namespace navvy::heightfield
