// SPDX-License-Identifier: Apache-2.0
// An update runs in two passes over what changed: first the layers that depend on a column alone,
// then those that follow from the elevation around it. Rectangles may overlap; a column that comes
// twice gets the same value twice.
#include "map/map_maker.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "core/error.h"

namespace navvy::map {

using heightfield::CellRect;

MapMaker::MapMaker(MapOptions options)
    : options_(std::make_shared<const MapOptions>(std::move(options))) {}

// Compares size and place only: the follower recognises another site of one size by itself, and
// then reports the whole of it.
bool MapMaker::is_of(const heightfield::TerrainView& view) const {
  return map_ && map_->nx() == view.nx() && map_->ny() == view.ny() &&
         map_->cell() == view.cell() && map_->origin() == view.origin();
}

// Sorts the rows of the layers by their rule once, so that an update does not test each of them in
// every column.
void MapMaker::start(const heightfield::TerrainView& view) {
  map_ = make_map(std::make_shared<const SiteColumns>(view, options_), 0);
  of_column_.clear();
  marking_.clear();
  of_surround_.clear();
  const std::vector<MapLayer>& marking = info(MapLayer::kDisturbedAt).from;
  for (const LayerInfo& row : layers()) {
    if (!wants(row.layer)) continue;
    if (row.of_surround != nullptr) of_surround_.push_back(&row);
    if (row.of_column == nullptr) continue;
    const bool marks = std::find(marking.begin(), marking.end(), row.layer) != marking.end();
    (marks ? marking_ : of_column_).push_back(&row);
  }
}

bool MapMaker::set(MapLayer layer, int ix, int iy, float value) {
  LayerTiles& tiles = map_->tiles_[index_of(layer)];
  // One NaN for all, so that maps compare bit by bit.
  return !tiles.empty() && tiles.set(ix, iy, value == value ? value : kUnknown, edition_);
}

// Blocks bound the memory of an update of the whole site.
void MapMaker::update_columns(const SiteColumns& site, const CellRect& rect) {
  const auto now = static_cast<float>(site.view().time());
  for_each_block(rect, [&](const CellRect& part) {
    const ColumnBlock block(site, part);
    for (int iy = part.y0; iy < part.y1; ++iy)
      for (int ix = part.x0; ix < part.x1; ++ix) {
        bool differs = false;
        // No short cut: each of them has to be written.
        for (const LayerInfo* row : marking_)
          differs = set(row->layer, ix, iy, row->of_column(block, ix, iy)) || differs;
        for (const LayerInfo* row : of_column_)
          set(row->layer, ix, iy, row->of_column(block, ix, iy));
        if (differs) set(MapLayer::kDisturbedAt, ix, iy, now);
      }
  });
}

// A column that two rectangles share is computed twice, with the same result.
void MapMaker::update_derived(const CellRect& rect) {
  for_each_block(rect, [&](const CellRect& block) {
    // Elevation is read from the map and not from the view: values follow from the floats that the
    // map reports.
    ElevationPatch patch{grown(block, options_->limits.reach(map_->cell())), map_->cell(), {}};
    patch.z = map_->copy(MapLayer::kElevation, patch.rect);
    if (wants(MapLayer::kOccupied)) patch.occupied = map_->copy(MapLayer::kOccupied, patch.rect);
    for_each_surround(patch, block, options_->limits, [&](int ix, int iy, Surround& surround) {
      for (const LayerInfo* row : of_surround_) set(row->layer, ix, iy, row->of_surround(surround));
    });
  });
}

// Bodies are few, and those that move change whole outlines. The list unites runs that lie side by
// side; its order does not matter, as it covers every change.
void MapMaker::add_moved(const OccupiedColumns& now, std::vector<CellRect>& rects) {
  std::vector<std::int64_t> moved;
  for (const auto& [column, top] : now) {
    const auto before = occupied_.find(column);
    if (before == occupied_.end() || before->second != top) moved.push_back(column);
  }
  for (const auto& [column, top] : occupied_)
    if (!now.contains(column)) moved.push_back(column);
  occupied_ = now;
  std::sort(moved.begin(), moved.end());
  heightfield::RectList list;
  const int nx = map_->nx();
  for (std::size_t i = 0, end = 0; i < moved.size(); i = end) {
    // One run along x.
    const int iy = static_cast<int>(moved[i] / nx), x0 = static_cast<int>(moved[i] % nx);
    for (end = i + 1; end < moved.size() && moved[end] == moved[end - 1] + 1 &&
                      static_cast<int>(moved[end] / nx) == iy;)
      ++end;
    list.add({x0, iy, x0 + static_cast<int>(end - i), iy + 1});
  }
  for (const CellRect& rect : list.rects()) rects.push_back(rect);
}

// The first view only sets the source of the tiles. Later ones write what changed.
const std::vector<CellRect>& MapMaker::update(const heightfield::TerrainView& view) {
  const bool first = !is_of(view);
  if (first) {
    forget();
    start(view);
  }
  // Writes of this update go to copies of the tiles that a map holds.
  ++edition_;
  std::vector<CellRect> rects = follower_.take(view);
  // The source of the first map computes it from this view.
  if (first) {
    changed_ = rects;
    if (wants(MapLayer::kOccupied)) occupied_ = occupied_columns(view, *options_);
    map_->time_ = view.time();
    map_->sequence_ = ++updates_;
    return changed_;
  }
  const SiteColumns site(view, options_);
  if (wants(MapLayer::kOccupied)) add_moved(site.occupied(), rects);
  for (const CellRect& rect : rects) update_columns(site, rect);
  // A derived value depends on columns around it; the list unites rectangles that overlap much.
  heightfield::RectList around;
  const int reach = options_->limits.reach(view.cell());
  for (const CellRect& rect : rects) around.add(grown(rect, reach).cut(view.site_rect()));
  changed_ = around.rects();
  if (!of_surround_.empty())
    for (const CellRect& rect : changed_) update_derived(rect);
  // Done last, so that an error above leaves the stamp of the map before.
  map_->time_ = view.time();
  map_->sequence_ = ++updates_;
  return changed_;
}

void MapMaker::forget() {
  follower_.forget();
  map_.reset();
  occupied_.clear();
}

TerrainMap MapMaker::map() {
  if (!map_) throw Error("MapMaker::map: there is no view yet; call update first");
  TerrainMap out = *map_;
  // Later writes go to copies, so that this map never changes.
  ++edition_;
  return out;
}

// A map without tiles in memory computes exactly the rectangle, block by block.
std::vector<float> layer_values(const heightfield::TerrainView& view, MapLayer layer,
                                const CellRect& rect, const MapOptions& options) {
  MapOptions wanted = options;
  wanted.layers = {layer};
  const auto shared = std::make_shared<const MapOptions>(std::move(wanted));
  return make_map(std::make_shared<const SiteColumns>(view, shared), 0).copy(layer, rect);
}

}  // namespace navvy::map
