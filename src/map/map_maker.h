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

/// Makes maps of one site, each of the view it was shown last.
///
/// Only columns that changed, and for the derived layers those round them, are computed anew; the
/// result is that of a full computation to the bit. What is as in the first view is computed from
/// that when a reader asks, so the first update costs nothing and a site takes memory only where it
/// changed or was looked at. An update costs what changed and a pointer for each tile of 64 x 64
/// columns and layer. Maps taken before stay as they were. One thread makes, any number reads the
/// maps.
class MapMaker {
 public:
  explicit MapMaker(MapOptions options);

  /// Brings the map up to date. Returns the columns with any changed value, as rectangles: at most
  /// 64, they may overlap, and may tell some that did not change. The whole site the first time,
  /// and for a view of another site.
  /// @throws InputError for a target that does not have a value a column, and for limits that make
  /// no sense.
  const std::vector<heightfield::CellRect>& update(const heightfield::TerrainView& view);
  /// The map as it is now. @throws Error before the first update.
  TerrainMap map();
  /// The next view is taken as the first of a site: nothing is known any more of what was before it
  /// (`disturbed_at`).
  void forget();

 private:
  bool is_of(const heightfield::TerrainView& view) const;
  void start(const heightfield::TerrainView& view);
  void update_columns(const SiteColumns& site, const heightfield::CellRect& rect);
  void update_derived(const heightfield::CellRect& rect);
  bool wants(MapLayer layer) const { return !map_->tiles_[index_of(layer)].empty(); }
  /// Whether that changed the value; an equal one is not written. Nothing happens to a layer that
  /// the map lacks.
  bool set(MapLayer layer, int ix, int iy, float value);

  std::shared_ptr<const MapOptions> options_;  // the maps' tiles are made by them, too
  heightfield::ChangeFollower follower_;
  std::vector<heightfield::CellRect> changed_;
  std::optional<TerrainMap> map_;
  std::uint64_t edition_ = 0;  // of the tiles that are written now
  std::uint64_t updates_ = 0;  // done so far, which number the maps
  // Rows of the layers that the map holds, by the rule that computes them; a change of a layer of
  // the second list stamps the column where the map keeps disturbed_at.
  std::vector<const LayerInfo*> of_column_, marking_, of_surround_;
};

/// Returns the values of one layer over `rect`, which must lie within the site: x fastest, row 0
/// with least y. Costs 10 to 60 ns a column. @throws InputError as MapMaker::update.
std::vector<float> layer_values(const heightfield::TerrainView& view, MapLayer layer,
                                const heightfield::CellRect& rect, const MapOptions& options = {});

}  // namespace navvy::map
