// SPDX-License-Identifier: Apache-2.0
// Storage of layers: a map of touched tiles for walks in a fixed order, and groups of pointers for
// direct access.
#include "heightfield/tiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/archive.h"

namespace navvy::heightfield {
namespace {

/// No column of a ground is higher above its rock [m]; activating one of a snapshot that is would
/// need more memory than exists.
constexpr double kMostHeight = 3e4;

/// The changed columns of a tile as they are hashed and saved: field by field, because a SoilLayer
/// has padding, and arrays take a fifth of the time of single numbers.
struct TileColumns {
  // Place of the columns in the tile.
  std::vector<std::uint16_t> place;
  // Number of layers of each column.
  std::vector<std::uint32_t> layers;
  // Fields of the layers, bottom first, one column after the other.
  std::vector<std::uint16_t> soil;
  std::vector<std::int64_t> mass;
  std::vector<float> specific_volume, plastic_shear;

  /// Copies a tile; earlier content is replaced.
  void take(const Tile& tile);
  void visit(Archive& a) {
    a("place", place);
    a("layers", layers);
    a("soil", soil);
    a("mass", mass);
    a("specific_volume", specific_volume);
    a("plastic_shear", plastic_shear);
  }
  /// Refuses values that no ground with `soils` soils can have.
  void check(Archive& a, std::size_t soils) const;
  /// Replaces the layers of a column by those of column number `c`, which begin at `layer`, and
  /// advances that.
  void give(std::size_t c, std::size_t& layer, Column& column) const;
};

// Arrays of one field each keep their capacity between tiles.
void TileColumns::take(const Tile& tile) {
  std::size_t all = 0, next = 0;
  for (const Column& column : tile.columns) all += column.size();
  place.clear();
  layers.clear();
  soil.resize(all);
  mass.resize(all);
  specific_volume.resize(all);
  plastic_shear.resize(all);
  for (std::size_t i = 0; i < kTileColumns; ++i) {
    if (tile.slot[i] < 0) continue;
    const Column& column = tile.columns[static_cast<std::size_t>(tile.slot[i])];
    place.push_back(static_cast<std::uint16_t>(i));
    layers.push_back(static_cast<std::uint32_t>(column.size()));
    for (const SoilLayer& layer : column) {
      soil[next] = layer.soil;
      mass[next] = layer.mass;
      specific_volume[next] = layer.specific_volume;
      plastic_shear[next] = layer.plastic_shear;
      ++next;
    }
  }
}

// A snapshot may be damaged, so every number is checked before it is used.
void TileColumns::check(Archive& a, std::size_t soils) const {
  const auto all = [](const auto& list, const auto& good) {
    return std::all_of(list.begin(), list.end(), good);
  };
  const bool ascend =
      std::adjacent_find(place.begin(), place.end(), std::greater_equal<>()) == place.end();
  a.require(ascend && (place.empty() || place.back() < kTileColumns), "place",
            "columns must ascend in their tile");
  const auto wanted = std::accumulate(layers.begin(), layers.end(), std::uint64_t{0});
  a.require(layers.size() == place.size() && soil.size() == wanted && mass.size() == wanted &&
                specific_volume.size() == wanted && plastic_shear.size() == wanted,
            "layers", "lists of columns and layers have other lengths");
  a.require(all(soil, [&](std::uint16_t s) { return s < soils; }), "soil",
            "the scene has fewer soils");
  a.require(all(mass, [](std::int64_t m) { return m > 0; }), "mass", "must be > 0");
  a.require(all(specific_volume, [](float v) { return v > 0 && std::isfinite(v); }),
            "specific_volume", "must be finite and > 0");
  a.require(all(plastic_shear, [](float v) { return std::isfinite(v); }), "plastic_shear",
            "must be finite");
}

void TileColumns::give(std::size_t c, std::size_t& layer, Column& column) const {
  column.clear();
  for (const std::size_t end = layer + layers[c]; layer < end; ++layer)
    column.push_back({soil[layer], mass[layer], specific_volume[layer], plastic_shear[layer]});
}

}  // namespace

Tiles::Tiles(std::shared_ptr<const StartSite> site)
    : site_(std::move(site)),
      tiles_x_(site_->tiles_x()),
      groups_x_((tiles_x_ + kTileSide - 1) / kTileSide) {
  start_mass_.assign(site_->setup().soils.size(), 0);
  groups_.resize(static_cast<std::size_t>(groups_x_) *
                 static_cast<std::size_t>((site_->tiles_y() + kTileSide - 1) / kTileSide));
}

Tile* Tiles::find_tile(int tx, int ty) const {
  // Two steps without a search: the soil reads columns in its innermost loops.
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

// The initial mass is counted once, when the column starts to differ.
Column& Tiles::touch_column(int ix, int iy) {
  Tile& tile = touch_tile(ix / kTileSide, iy / kTileSide);
  std::int16_t& slot = tile.slot[static_cast<std::size_t>(index_in_tile(ix, iy))];
  if (slot < 0) {
    // Made before a slot is taken, because the source may throw.
    Column column;
    site_->column(ix, iy, column);
    for (const SoilLayer& layer : column) start_mass_[layer.soil] += layer.mass;
    slot = static_cast<std::int16_t>(tile.columns.size());
    tile.columns.push_back(std::move(column));
  }
  return tile.columns[static_cast<std::size_t>(slot)];
}

void Tiles::update_surface(int ix, int iy, SurfaceTable& table, const StartHeights& start) const {
  // Height, soil and density state change together, so that a view never shows half an edit.
  const Column& column = *find_column(ix, iy);
  SurfaceTile& surface = table.own(ix / kTileSide, iy / kTileSide, start);
  const auto i = static_cast<std::size_t>(index_in_tile(ix, iy));
  surface.height[i] = site_->setup().datum + column_height(column, unit());
  // A column dug down to bedrock shows the soil that was there.
  surface.soil[i] = column.empty() ? kSoilAsAtStart : column.back().soil;
  surface.specific_volume[i] = column.empty() ? 1.0f : column.back().specific_volume;
}

void Tiles::update_surfaces(SurfaceTable& table, const StartHeights& start) const {
  for (const auto& [key, tile] : touched_) {
    const int x = static_cast<int>(key % tiles_x_) * kTileSide,
              y = static_cast<int>(key / tiles_x_) * kTileSide;
    for (int i = 0; i < kTileColumns; ++i)
      if (tile->slot[static_cast<std::size_t>(i)] >= 0)
        update_surface(x + i % kTileSide, y + i / kTileSide, table, start);
  }
}

// Goes tile by tile with one buffer.
void Tiles::visit(Archive& a) {
  if (a.loading()) clear();
  const std::uint64_t count = a.size("tiles", touched_.size());
  auto next = touched_.begin();
  std::int64_t before = -1;
  TileColumns columns;
  for (std::uint64_t n = 0; n < count; ++n) {
    a.item(n, [&] {
      std::int64_t key = a.loading() ? 0 : next->first;
      a.ranged("key", key, before + 1, static_cast<std::int64_t>(tiles_x_) * site_->tiles_y() - 1);
      before = key;
      if (!a.loading()) columns.take(*(next++)->second);
      columns.visit(a);
      if (!a.loading()) return;
      columns.check(a, site_->setup().soils.size());
      const int tx = static_cast<int>(key % tiles_x_), ty = static_cast<int>(key / tiles_x_);
      touch_tile(tx, ty);
      std::size_t layer = 0;
      for (std::size_t c = 0; c < columns.place.size(); ++c) {
        const int place = columns.place[c];
        const int ix = tx * kTileSide + place % kTileSide, iy = ty * kTileSide + place / kTileSide;
        // The last tiles of a row or column reach beyond the site.
        a.require(ix < site_->setup().nx && iy < site_->setup().ny, "place",
                  "a column is outside the site");
        // Touching it counts its initial mass; its layers are the saved ones.
        Column& column = touch_column(ix, iy);
        columns.give(c, layer, column);
        a.require(column_height(column, unit()) < kMostHeight, "layers",
                  "a column reaches higher than any ground");
      }
    });
  }
}

void Tiles::clear() {
  // Groups hold pointers into the map, so they are cleared with it.
  touched_.clear();
  for (auto& group : groups_) group.reset();
  std::fill(start_mass_.begin(), start_mass_.end(), 0);
}

}  // namespace navvy::heightfield
