// SPDX-License-Identifier: Apache-2.0
// Keeps the map of a site up to date from one view of its terrain to the next.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "heightfield/change_follower.h"
#include "map/column_block.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Makes maps of one site, each from the latest view.
///
/// An update recomputes only columns that changed, and derived layers in the window around them;
/// the result is bit-identical to a full computation. Columns that are as in the first view are
/// computed from that view when a reader asks, so that the first update costs nothing and a site
/// takes memory only where it changed or was read column by column. An update costs what changed,
/// and a pointer per layer and tile of 64 x 64 columns. Maps taken before never change. One thread
/// updates; any number of threads read the maps.
class MapMaker {
 public:
  /// Makes maps with these options.
  explicit MapMaker(MapOptions options);

  /// Brings the map up to date. Returns at most 64 rectangles that cover the columns with any
  /// changed value; they may overlap and may include columns that did not change. Returns the whole
  /// site the first time, and for a view of another site.
  /// @throws InputError for a target with another number of values than the site has columns, and
  /// for limits that are not finite and positive.
  const std::vector<heightfield::CellRect>& update(const heightfield::TerrainView& view);
  /// Returns the present map. @throws Error before the first update.
  TerrainMap map();
  /// Makes the next update start anew, without history (`disturbed_at`).
  void forget();

 private:
  /// Returns true when the map is of the same size and place as the view.
  bool is_of(const heightfield::TerrainView& view) const;
  /// Makes the map of the first view.
  void start(const heightfield::TerrainView& view);
  /// Updates the layers that depend on a column alone.
  void update_columns(const SiteColumns& site, const heightfield::CellRect& rect);
  /// Updates the layers that follow from the elevation around a column.
  void update_derived(const heightfield::CellRect& rect);
  /// Returns true when the map holds the layer.
  bool wants(MapLayer layer) const { return !map_->tiles_[index_of(layer)].empty(); }
  /// Writes a value and returns true when it changed. Does nothing for a layer that the map does
  /// not hold.
  bool set(MapLayer layer, int ix, int iy, float value);

  // Shared with the sources of the tiles.
  std::shared_ptr<const MapOptions> options_;
  heightfield::ChangeFollower follower_;
  std::vector<heightfield::CellRect> changed_;
  std::optional<TerrainMap> map_;
  // Edition of the tiles that are written now.
  std::uint64_t edition_ = 0;
  // Number of updates so far, which numbers the maps.
  std::uint64_t updates_ = 0;
  // Rows of the layers that the map holds, by the rule that computes them. A change of a layer in
  // marking_ stamps the column where the map holds disturbed_at.
  std::vector<const LayerInfo*> of_column_, marking_, of_surround_;
};

/// Returns the values of one layer over `rect`, which must lie within the site: x fastest, row 0
/// with least y. Costs 10 to 60 ns per column. @throws InputError as MapMaker::update.
std::vector<float> layer_values(const heightfield::TerrainView& view, MapLayer layer,
                                const heightfield::CellRect& rect, const MapOptions& options = {});

}  // namespace navvy::map
