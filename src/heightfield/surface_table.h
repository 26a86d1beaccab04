// SPDX-License-Identifier: Apache-2.0
// The surface of the tiles that differ from the untouched site, shared between a live ground and
// the views of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "heightfield/start_site.h"

namespace navvy::heightfield {

/// Says of a column that its surface soil is the untouched site's.
inline constexpr std::uint16_t kSoilAsAtStart = 0xFFFF;

/// What can be seen of the 1024 columns of a tile, x fastest.
struct SurfaceTile {
  /// Surface in W [m], loose soil included where there is any.
  TileHeights height;
  /// Of the uppermost layer; kSoilAsAtStart.
  std::array<std::uint16_t, kTileColumns> soil;
  /// Of the uppermost layer: volume / bank volume.
  std::array<float, kTileColumns> specific_volume;
  std::shared_ptr<const TileHeights> start;  ///< W [m] of the untouched site
  /// Depth of loose soil [m]; null: there is none.
  std::shared_ptr<std::array<float, kTileColumns>> loose;
  bool frozen = false;  ///< shared with a copy of the table; only who writes asks for it
};

/// A sparse table of surface tiles that is cheap to copy: copies share tiles, and who writes to a
/// shared one first makes its own (14 KiB). A copy costs 1.6 kB a km2 of 0.1 m columns, however
/// much was dug.
///
/// One thread writes. Copies made after `freeze` may be read by any thread, also while the original
/// is written to.
class SurfaceTable {
 public:
  /// Of an untouched site.
  explicit SurfaceTable(const StartSite& site);

  /// The tile, null where the site is untouched.
  const SurfaceTile* find(int tx, int ty) const {
    const Square* square = squares_[square_of(tx, ty)].get();
    return square != nullptr ? square->tiles[static_cast<std::size_t>(index_in_tile(tx, ty))].get()
                             : nullptr;
  }
  /// The tile to write to, made from the untouched site where there is none.
  SurfaceTile& own(int tx, int ty, const StartHeights& start);
  /// Marks everything as shared. To be called before a copy that lives on; costs what was written
  /// since the last call.
  void freeze() const;
  /// Back to the untouched site; copies keep what they have.
  void clear();

  // For who compares two tables: they differ in no tile of a square for which both give the same
  // pointer.
  std::size_t squares() const { return squares_.size(); }
  /// Identity of a square of 32 x 32 tiles, null while it is untouched; not to be followed.
  const void* square(std::size_t s) const { return squares_[s].get(); }
  /// Coordinates of the first tile of a square of 32 x 32.
  int first_tx(std::size_t s) const { return static_cast<int>(s) % squares_x_ * kTileSide; }
  int first_ty(std::size_t s) const { return static_cast<int>(s) / squares_x_ * kTileSide; }
  int tiles_x() const { return tiles_x_; }
  int tiles_y() const { return tiles_y_; }

 private:
  // Pointers to tiles stand in squares that are shared like the tiles themselves: a copy of the
  // table copies one pointer for every 1024 tiles.
  struct Square {
    std::array<std::shared_ptr<SurfaceTile>, kTileColumns> tiles;
    bool frozen = false;
  };
  struct Place {
    int tx, ty;
  };
  std::size_t square_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(squares_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  int tiles_x_, tiles_y_, squares_x_;
  std::vector<std::shared_ptr<Square>> squares_;
  mutable std::vector<Place> written_;  // tiles that are this table's alone
};

}  // namespace navvy::heightfield
