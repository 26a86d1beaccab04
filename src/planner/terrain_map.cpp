// SPDX-License-Identifier: Apache-2.0
// Tiles that maps share, and dense copies for writers.
#include "planner/terrain_map.h"

#include <algorithm>
#include <string>

#include "core/error.h"

namespace navvy::planner {

LayerTiles::LayerTiles(int nx, int ny)
    : across_((nx + kSide - 1) / kSide),
      tiles_(static_cast<std::size_t>(across_) * static_cast<std::size_t>((ny + kSide - 1) / kSide)) {}

void LayerTiles::set(int ix, int iy, float value, std::uint64_t edition) {
  // Three cases: new, a map's, or written to before in this edition.
  std::shared_ptr<Tile>& tile = tiles_[tile_of(ix, iy)];
  if (!tile) {
    tile = std::make_shared<Tile>();
    tile->values.fill(kUnknown);
    tile->edition = edition;
  } else if (tile->edition != edition) {
    // A map of an earlier edition may hold it; how many do is not asked, as their threads may drop it this moment.
    tile = std::make_shared<Tile>(*tile);
    tile->edition = edition;
  }
  tile->values[place(ix, iy)] = value;
}

LayerTiles::View LayerTiles::view(int tx, int ty) const {
  // All tiles that nobody wrote to look at this one.
  static const std::array<float, static_cast<std::size_t>(kSide)* kSide> unknown = [] {
    std::array<float, static_cast<std::size_t>(kSide) * kSide> out{};
    out.fill(kUnknown);
    return out;
  }();
  const Tile* tile = tiles_[tile_of(tx * kSide, ty * kSide)].get();
  return View(tile != nullptr ? tile->values.data() : unknown.data());
}

TerrainMap::TerrainMap(const heightfield::GroundSetup& setup, double time, std::uint64_t sequence)
    : time_(time), sequence_(sequence) {
  heightfield::GroundSetup kept = setup;
  // It may hold the whole map that the site was cut from.
  kept.surface = nullptr;
  setup_ = std::make_shared<const heightfield::GroundSetup>(std::move(kept));
}

std::vector<float> TerrainMap::copy(Layer layer, const heightfield::CellRect& rect) const {
  if (rect.empty()) return {};
  // Unknown first; what lies in known tiles comes over it run by run.
  const auto width = static_cast<std::size_t>(rect.x1 - rect.x0);
  std::vector<float> out(static_cast<std::size_t>(rect.area()), kUnknown);
  const LayerTiles& from = tiles_[index_of(layer)];
  const heightfield::CellRect inside = rect.cut(this->rect());
  if (from.empty() || inside.empty()) return out;
  for (int iy = inside.y0; iy < inside.y1; ++iy)
    for (int ix = inside.x0, count = 0; ix < inside.x1; ix += count) {
      const float* values = from.row(ix, iy, count);
      count = std::min(count, inside.x1 - ix);
      // An unknown tile is passed over at once.
      if (values == nullptr) continue;
      std::copy(
          values, values + count,
          out.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(iy - rect.y0) * width) + (ix - rect.x0));
    }
  return out;
}

TerrainMap TerrainMap::with(Layer layer, std::span<const float> values) const {
  if (static_cast<std::int64_t>(values.size()) != rect().area())
    throw Error("TerrainMap::with: " + std::to_string(values.size()) + " values for " + std::to_string(nx()) + " x " +
                std::to_string(ny()) + " columns");
  // Shares every other layer with this map.
  TerrainMap out = *this;
  LayerTiles& to = out.tiles_[index_of(layer)];
  to = LayerTiles(nx(), ny());
  for (int iy = 0; iy < ny(); ++iy)
    for (int ix = 0; ix < nx(); ++ix) {
      const float value = values[static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx()) + ix];
      // Unknown tiles stay without memory. Every NaN is the same one, so that maps compare bit by bit.
      if (value == value) to.set(ix, iy, value, sequence_);
    }
  return out;
}

}  // namespace navvy::planner
