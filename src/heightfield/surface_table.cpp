// SPDX-License-Identifier: Apache-2.0
// Copy on write in two steps, squares of tiles and tiles. Sharing is not derived from a reference
// count, which other threads change, but from a mark that only the writing thread sets and reads.
#include "heightfield/surface_table.h"

namespace navvy::heightfield {

SurfaceTable::SurfaceTable(const StartSite& site)
    : tiles_x_(site.tiles_x()),
      tiles_y_(site.tiles_y()),
      squares_x_((tiles_x_ + kTileSide - 1) / kTileSide),
      squares_(static_cast<std::size_t>(squares_x_) *
               static_cast<std::size_t>((tiles_y_ + kTileSide - 1) / kTileSide)) {}

SurfaceTile& SurfaceTable::own(int tx, int ty, const StartHeights& start) {
  // First the square, then the tile in it: either may be shared with a view.
  std::shared_ptr<Square>& square = squares_[square_of(tx, ty)];
  if (!square) {
    square = std::make_shared<Square>();
  } else if (square->frozen) {
    // Copies keep the old square; its tiles stay shared until they are written.
    square = std::make_shared<Square>(*square);
    square->frozen = false;
  }
  std::shared_ptr<SurfaceTile>& tile =
      square->tiles[static_cast<std::size_t>(index_in_tile(tx, ty))];
  // The common case: the second and later columns of a tile after a view was taken.
  if (tile && !tile->frozen) return *tile;
  if (tile) {
    tile = std::make_shared<SurfaceTile>(*tile);
    tile->frozen = false;
  } else {
    // Filled before it is stored, because the source of heights may throw.
    auto fresh = std::make_shared<SurfaceTile>();
    auto heights = std::make_shared<TileHeights>();
    const TileHeights& found = start.passing(tx, ty, *heights);
    if (&found != heights.get()) *heights = found;
    fresh->height = *heights;
    fresh->start = std::move(heights);
    fresh->soil.fill(kSoilAsAtStart);
    fresh->specific_volume.fill(1.0f);
    tile = std::move(fresh);
  }
  written_.push_back({tx, ty});
  return *tile;
}

// Only tiles that were written since the last call need a mark.
void SurfaceTable::freeze() const {
  // Everything else is shared already.
  for (const Place& place : written_) {
    Square& square = *squares_[square_of(place.tx, place.ty)];
    square.frozen = true;
    square.tiles[static_cast<std::size_t>(index_in_tile(place.tx, place.ty))]->frozen = true;
  }
  written_.clear();
}

void SurfaceTable::clear() {
  for (auto& square : squares_) square.reset();
  written_.clear();
}

}  // namespace navvy::heightfield
