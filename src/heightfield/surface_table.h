// SPDX-License-Identifier: Apache-2.0
// The surface of the tiles that differ from the untouched site, shared between a live ground and
// its views.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "heightfield/start_site.h"

namespace navvy::heightfield {

/// Marks a column whose surface soil is that of the untouched site.
inline constexpr std::uint16_t kSoilAsAtStart = 0xFFFF;

/// The visible state of the 1024 columns of a tile, x fastest.
struct SurfaceTile {
  /// Height of the surface in W [m], with loose soil where there is any.
  TileHeights height;
  /// Soil of the uppermost layer, or kSoilAsAtStart.
  std::array<std::uint16_t, kTileColumns> soil;
  /// Volume over bank volume of the uppermost layer.
  std::array<float, kTileColumns> specific_volume;
  /// Height of the untouched site in W [m].
  std::shared_ptr<const TileHeights> start;
  /// Depth of loose soil [m]; null where there is none.
  std::shared_ptr<std::array<float, kTileColumns>> loose;
  /// True when a copy of the table shares the tile; only the writer asks for it.
  bool frozen = false;
};

/// A sparse table of surface tiles that is cheap to copy. Copies share tiles; a writer first makes
/// its own copy of a shared tile (14 KiB). Copying the table costs 1.6 kB per km2 of 0.1 m columns,
/// however much was dug.
///
/// One thread writes. Any thread may read copies made after `freeze`, also while the original is
/// written to.
class SurfaceTable {
 public:
  /// Makes the table of an untouched site.
  explicit SurfaceTable(const StartSite& site);

  /// Returns the tile, or null where the site is untouched.
  const SurfaceTile* find(int tx, int ty) const {
    const Square* square = squares_[square_of(tx, ty)].get();
    return square != nullptr ? square->tiles[static_cast<std::size_t>(index_in_tile(tx, ty))].get()
                             : nullptr;
  }
  /// Returns the tile for writing, made from the untouched site where there is none.
  SurfaceTile& own(int tx, int ty, const StartHeights& start);
  /// Marks all tiles as shared. Must be called before the table is copied for others; costs what
  /// was written since the last call.
  void freeze() const;
  /// Returns to the untouched site. Copies keep their tiles.
  void clear();

  // For comparing two tables: they agree in all tiles of a square for which both return the same
  // pointer.
  std::size_t squares() const { return squares_.size(); }
  /// Returns the identity of a square of 32 x 32 tiles; null while it is untouched. It must not be
  /// dereferenced.
  const void* square(std::size_t s) const { return squares_[s].get(); }
  /// Returns the coordinates of the first tile of a square of 32 x 32.
  int first_tx(std::size_t s) const { return static_cast<int>(s) % squares_x_ * kTileSide; }
  int first_ty(std::size_t s) const { return static_cast<int>(s) / squares_x_ * kTileSide; }
  int tiles_x() const { return tiles_x_; }
  int tiles_y() const { return tiles_y_; }

 private:
  // Squares hold the pointers to tiles and are shared like the tiles themselves: copying the table
  // copies one pointer per 1024 tiles.
  struct Square {
    std::array<std::shared_ptr<SurfaceTile>, kTileColumns> tiles;
    bool frozen = false;
  };
  // Coordinates of a tile.
  struct Place {
    int tx, ty;
  };
  std::size_t square_of(int tx, int ty) const {
    return static_cast<std::size_t>(ty / kTileSide) * static_cast<std::size_t>(squares_x_) +
           static_cast<std::size_t>(tx / kTileSide);
  }
  int tiles_x_, tiles_y_, squares_x_;
  std::vector<std::shared_ptr<Square>> squares_;
  // Tiles that belong to this table alone.
  mutable std::vector<Place> written_;
};

}  // namespace navvy::heightfield
