// SPDX-License-Identifier: Apache-2.0
// Storage of layers: a map of touched tiles for walks in a fixed order, and pointers in groups for finding one at once.
#include "heightfield/tiles.h"

#include <algorithm>

namespace navvy::heightfield {

Tiles::Tiles(std::shared_ptr<const StartSite> site)
    : site_(std::move(site)), tiles_x_(site_->tiles_x()), groups_x_((tiles_x_ + kTileSide - 1) / kTileSide) {
  start_mass_.assign(site_->setup().soils.size(), 0);
  groups_.resize(static_cast<std::size_t>(groups_x_) *
                 static_cast<std::size_t>((site_->tiles_y() + kTileSide - 1) / kTileSide));
}

Tile* Tiles::find_tile(int tx, int ty) const {
  // Two steps without a search: soil asks for columns in its innermost loops.
  const auto& group = groups_[group_of(tx, ty)];
  return group ? (*group)[static_cast<std::size_t>(index_in_tile(tx, ty))] : nullptr;
}

Tile& Tiles::touch_tile(int tx, int ty) {
  if (Tile* tile = find_tile(tx, ty)) return *tile;
  auto tile = std::make_unique<Tile>();
  tile->slot.fill(-1);
  auto& group = groups_[group_of(tx, ty)];
  if (!group) {
    group = std::make_unique<Group>();
    group->fill(nullptr);
  }
  // Owned by the map, whose order is that of hashes and files; found through the group.
  Tile* raw = tile.get();
  (*group)[static_cast<std::size_t>(index_in_tile(tx, ty))] = raw;
  touched_[static_cast<std::int64_t>(ty) * tiles_x_ + tx] = std::move(tile);
  return *raw;
}

const Column* Tiles::find_column(int ix, int iy) const {
  const Tile* tile = find_tile(ix / kTileSide, iy / kTileSide);
  if (tile == nullptr) return nullptr;
  const int slot = tile->slot[static_cast<std::size_t>(index_in_tile(ix, iy))];
  return slot < 0 ? nullptr : &tile->columns[static_cast<std::size_t>(slot)];
}

Column& Tiles::touch_column(int ix, int iy) {
  Tile& tile = touch_tile(ix / kTileSide, iy / kTileSide);
  std::int16_t& slot = tile.slot[static_cast<std::size_t>(index_in_tile(ix, iy))];
  if (slot < 0) {
    // Made before a slot is taken: the source may throw.
    Column column;
    site_->column(ix, iy, column);
    for (const Layer& layer : column) start_mass_[layer.soil] += layer.mass;
    slot = static_cast<std::int16_t>(tile.columns.size());
    tile.columns.push_back(std::move(column));
  }
  return tile.columns[static_cast<std::size_t>(slot)];
}

void Tiles::update_surface(int ix, int iy, SurfaceTable& table, const StartHeights& start) const {
  // Height, soil and density state together, so that a view never shows half an edit.
  const Column& column = *find_column(ix, iy);
  SurfaceTile& surface = table.own(ix / kTileSide, iy / kTileSide, start);
  const auto i = static_cast<std::size_t>(index_in_tile(ix, iy));
  surface.height[i] = site_->setup().datum + column_height(column, unit());
  // A column dug down to bedrock still shows the soil that lay there.
  surface.soil[i] = column.empty() ? kSoilAsAtStart : column.back().soil;
  surface.specific_volume[i] = column.empty() ? 1.0f : column.back().specific_volume;
}

void Tiles::clear() {
  // Groups hold pointers into the map, so they go with it.
  touched_.clear();
  for (auto& group : groups_) group.reset();
  std::fill(start_mass_.begin(), start_mass_.end(), 0);
}

}  // namespace navvy::heightfield
