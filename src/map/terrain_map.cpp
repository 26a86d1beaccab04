// SPDX-License-Identifier: Apache-2.0
// Tiles that maps share, tiles that are computed on demand, and dense copies for writers.
#include "map/terrain_map.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <string>
#include <utility>

#include "core/error.h"

namespace navvy::map {

using heightfield::CellRect;

/// Filled in by const calls: atomic, and never changed once set. All maps with the source share it.
struct LayerTiles::Asked {
  Asked(MapLayer l, std::shared_ptr<const LayerSource> s, std::size_t tiles)
      : layer(l), source(std::move(s)), values(tiles) {}
  ~Asked() {
    for (const auto& each : values) delete each.load(std::memory_order_relaxed);
  }
  MapLayer layer;
  std::shared_ptr<const LayerSource> source;
  mutable std::vector<std::atomic<const Values*>> values;
};

LayerTiles::LayerTiles(int nx, int ny, MapLayer layer, std::shared_ptr<const LayerSource> source)
    : nx_(nx),
      ny_(ny),
      across_((nx + kSide - 1) / kSide),
      tiles_(static_cast<std::size_t>(across_) *
             static_cast<std::size_t>((ny + kSide - 1) / kSide)) {
  if (source) asked_ = std::make_shared<const Asked>(layer, std::move(source), tiles_.size());
}

// Beyond the edge of the site a tile is unknown.
void LayerTiles::compute(std::size_t tile, Values& to) const {
  const int x0 = static_cast<int>(tile % static_cast<std::size_t>(across_)) * kSide;
  const int y0 = static_cast<int>(tile / static_cast<std::size_t>(across_)) * kSide;
  to.fill(kUnknown);
  if (asked_)
    asked_->source->fill(asked_->layer,
                         CellRect{x0, y0, x0 + kSide, y0 + kSide}.cut({0, 0, nx_, ny_}), to.data(),
                         kSide);
}

// A written tile replaces one that was computed by the source.
const float* LayerTiles::present(std::size_t tile) const {
  if (tiles_[tile]) return tiles_[tile]->values.data();
  const Values* asked = asked_ ? asked_->values[tile].load(std::memory_order_acquire) : nullptr;
  return asked != nullptr ? asked->data() : nullptr;
}

// Lock-free: readers in many threads must not wait for each other.
const float* LayerTiles::ask(std::size_t tile) const {
  if (const float* known = present(tile)) return known;
  // Computed before it is published: the source may throw half way.
  auto fresh = std::make_unique<Values>();
  compute(tile, *fresh);
  const Values* first = nullptr;
  // Two threads computed the same numbers, so it does not matter whose are kept.
  if (asked_->values[tile].compare_exchange_strong(first, fresh.get(), std::memory_order_acq_rel))
    first = fresh.release();
  return first->data();
}

const float* LayerTiles::passing(int tx, int ty, Values& buffer) const {
  const std::size_t tile = tile_of(tx * kSide, ty * kSide);
  if (const float* known = present(tile)) return known;
  if (!asked_) return nullptr;
  compute(tile, buffer);
  return buffer.data();
}

// Tiles that no one wrote to are the same if both maps have the same source.
bool LayerTiles::shares(const LayerTiles& other, int tx, int ty) const {
  const std::size_t tile = tile_of(tx * kSide, ty * kSide);
  return tiles_[tile] == other.tiles_[tile] && (tiles_[tile] || asked_ == other.asked_);
}

// Copy on write: the maps taken in earlier editions keep their tiles.
bool LayerTiles::set(int ix, int iy, float value, std::uint64_t edition) {
  const std::size_t number = tile_of(ix, iy), at = place(ix, iy);
  std::shared_ptr<WrittenTile>& tile = tiles_[number];
  const float* known = present(number);
  // From its source at once: who writes one column of a tile writes more.
  if (known == nullptr && asked_) {
    auto fresh = std::make_shared<WrittenTile>();
    compute(number, fresh->values);
    fresh->edition = edition;
    tile = std::move(fresh);
    known = tile->values.data();
  }
  const float before = known != nullptr ? known[at] : kUnknown;
  if (std::bit_cast<std::uint32_t>(before) == std::bit_cast<std::uint32_t>(value)) return false;
  if (!tile || tile->edition != edition) {
    // A map of an earlier edition may hold it; how many do is not asked, as their threads may drop
    // it this moment.
    auto fresh = std::make_shared<WrittenTile>();
    if (known != nullptr)
      std::copy(known, known + fresh->values.size(), fresh->values.begin());
    else
      fresh->values.fill(kUnknown);
    fresh->edition = edition;
    tile = std::move(fresh);
  }
  tile->values[at] = value;
  return true;
}

void LayerTiles::copy(const CellRect& rect, float* out, std::size_t stride) const {
  // Four tiles a side at once: layers that look around compute as many columns beside them for one
  // tile as for sixteen.
  constexpr int kBlock = 4 * kSide;
  const auto next = [](int i, int by, int end) { return std::min((i / by + 1) * by, end); };
  const auto target = [&](int ix, int iy) {
    return out + static_cast<std::size_t>(iy - rect.y0) * stride +
           static_cast<std::size_t>(ix - rect.x0);
  };
  for (int y0 = rect.y0, y1 = 0; y0 < rect.y1; y0 = y1) {
    y1 = next(y0, kBlock, rect.y1);
    for (int x0 = rect.x0, x1 = 0; x0 < rect.x1; x0 = x1) {
      x1 = next(x0, kBlock, rect.x1);
      bool all = true;
      for (int iy = y0; iy < y1; iy = next(iy, kSide, y1))
        for (int ix = x0; ix < x1; ix = next(ix, kSide, x1))
          all = all && present(tile_of(ix, iy)) != nullptr;
      // What is in memory comes over it.
      if (!all && asked_)
        asked_->source->fill(asked_->layer, {x0, y0, x1, y1}, target(x0, y0), stride);
      for (int iy = y0; iy < y1; ++iy)
        for (int ix = x0, end = 0; ix < x1; ix = end) {
          end = next(ix, kSide, x1);
          const float* tile = present(tile_of(ix, iy));
          if (tile != nullptr)
            std::copy(tile + place(ix, iy), tile + place(ix, iy) + (end - ix), target(ix, iy));
          else if (!asked_)
            std::fill(target(ix, iy), target(ix, iy) + (end - ix), kUnknown);
        }
    }
  }
}

TerrainMap::TerrainMap(const heightfield::GroundSetup& setup, double time, std::uint64_t sequence)
    : time_(time), sequence_(sequence) {
  heightfield::GroundSetup stored = setup;
  // It may hold the whole map that the site was cut from.
  stored.surface = nullptr;
  setup_ = std::make_shared<const heightfield::GroundSetup>(std::move(stored));
}

std::vector<float> TerrainMap::copy(MapLayer layer, const CellRect& rect) const {
  if (rect.empty()) return {};
  // Unknown first; what lies on the site comes over it.
  const auto width = static_cast<std::size_t>(rect.x1 - rect.x0);
  std::vector<float> out(static_cast<std::size_t>(rect.area()), kUnknown);
  const LayerTiles& from = tiles_[index_of(layer)];
  const CellRect inside = rect.cut(this->rect());
  if (!from.empty() && !inside.empty())
    from.copy(inside,
              out.data() + static_cast<std::size_t>(inside.y0 - rect.y0) * width +
                  static_cast<std::size_t>(inside.x0 - rect.x0),
              width);
  return out;
}

TerrainMap TerrainMap::with(MapLayer layer, std::span<const float> values) const {
  if (static_cast<std::int64_t>(values.size()) != rect().area())
    throw Error("TerrainMap::with: " + std::to_string(values.size()) + " values for " +
                std::to_string(nx()) + " x " + std::to_string(ny()) + " columns");
  // Shares every other layer with this map.
  TerrainMap out = *this;
  LayerTiles& to = out.tiles_[index_of(layer)];
  to = LayerTiles(nx(), ny(), layer, nullptr);
  for (int iy = 0; iy < ny(); ++iy)
    for (int ix = 0; ix < nx(); ++ix) {
      const float value =
          values[static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx()) + ix];
      // Unknown tiles stay without memory. Every NaN is the same one, so that maps compare bit by
      // bit.
      if (value == value) to.set(ix, iy, value, sequence_);
    }
  return out;
}

// A copy counts a reference for every tile of every layer: milliseconds on a site of 1 km2.
TerrainMap TerrainMap::numbered(std::uint64_t sequence) && {
  sequence_ = sequence;
  return std::move(*this);
}

}  // namespace navvy::map
