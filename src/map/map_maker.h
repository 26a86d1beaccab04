// SPDX-License-Identifier: Apache-2.0
// Keeps the map of a site up to date as its terrain changes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "heightfield/change_follower.h"
#include "map/column_block.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Makes maps of one site, each from the latest terrain view.
///
/// An update recomputes only the columns that changed, and derived layers in the window around each
/// of them. The result is bit-identical to a full computation. Columns that never changed are
/// computed from the first view when they are read. The first update therefore takes almost no
/// time, and memory is needed only for the parts of the site that changed or were read column by
/// column.
///
/// Maps returned earlier never change. One thread makes updates; any number of threads may read the
/// maps.
class MapMaker {
 public:
  /// Stores the options of the maps. The first call of `update` makes the first map.
  explicit MapMaker(MapOptions options);

  /// Updates the map to the terrain of `view`. Returns at most 64 rectangles that cover all columns
  /// with a changed value. They may overlap, and may contain unchanged columns. The first call, and
  /// a view of another site, return the whole site. The reference is valid until the next call.
  /// @throws InputError if the options contain a target whose size is not the number of columns, or
  /// limits that are not finite and positive.
  const std::vector<heightfield::CellRect>& update(const heightfield::TerrainView& view);
  /// Returns the current map. @throws Error if `update` was never called.
  TerrainMap map();
  /// Discards the map and its history (layer `disturbed_at`). The next update behaves like the
  /// first one.
  void forget();

 private:
  /// Adds rectangles around all columns that bodies began or ceased to occupy, or on which their
  /// height changed, and stores `now` as the occupied columns.
  void add_moved(const OccupiedColumns& now, std::vector<heightfield::CellRect>& rects);
  /// Returns true if the current map has the size and position of the site in `view`.
  bool is_of(const heightfield::TerrainView& view) const;
  /// Makes the map of the first view of a site.
  void start(const heightfield::TerrainView& view);
  /// Updates the layers that are computed from single columns, for all columns in `rect`.
  void update_columns(const SiteColumns& site, const heightfield::CellRect& rect);
  /// Updates the layers that are computed from nearby elevations, for all columns in `rect`.
  void update_derived(const heightfield::CellRect& rect);
  /// Returns true if the map contains `layer`.
  bool wants(MapLayer layer) const { return !map_->tiles_[index_of(layer)].empty(); }
  /// Writes the value of `layer` in column (ix, iy). Returns true if the value changed. Does
  /// nothing and returns false if the map does not contain the layer.
  bool set(MapLayer layer, int ix, int iy, float value);

  /// Options of the maps, shared with the sources that compute tiles.
  std::shared_ptr<const MapOptions> options_;
  /// Finds the columns that changed since the last view.
  heightfield::ChangeFollower follower_;
  /// Rectangles returned by the last update.
  std::vector<heightfield::CellRect> changed_;
  /// Current map; empty before the first update.
  std::optional<TerrainMap> map_;
  /// Edition number with which tiles are written. Increased before every update and whenever a map
  /// is returned, so that tiles of returned maps are copied instead of written.
  std::uint64_t edition_ = 0;
  /// Columns that bodies occupied at the last update.
  OccupiedColumns occupied_;
  /// Number of updates so far, which is the sequence number of the current map.
  std::uint64_t updates_ = 0;
  /// Layers of the map, by the function that computes them: from a single column (`of_column_` and
  /// `marking_`), or from nearby elevations (`of_surround_`). A change in one of the layers in
  /// `marking_` sets the column's value in the layer `disturbed_at`.
  std::vector<const LayerInfo*> of_column_, marking_, of_surround_;
};

/// Returns the values of one layer for the columns in `rect`, which must lie within the site: x
/// fastest, beginning with the row of smallest y. Takes 10 to 60 ns per column. @throws InputError
/// as MapMaker::update.
std::vector<float> layer_values(const heightfield::TerrainView& view, MapLayer layer,
                                const heightfield::CellRect& rect, const MapOptions& options = {});

}  // namespace navvy::map
