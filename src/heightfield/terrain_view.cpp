// SPDX-License-Identifier: Apache-2.0
#include "heightfield/terrain_view.h"

namespace navvy::heightfield {

// Copies only tiles with loose soil; all others stay shared with the ground.
TerrainView TerrainView::with(const LooseSoil& loose, SurfaceKind surface) const {
  TerrainView out = *this;
  out.surface_ = surface;
  for (const LooseSoil::Column& column : loose.columns()) {
    // Everything in a view is shared, so the first column of a tile makes the copy that the others
    // write to.
    SurfaceTile& tile = out.table_.own(column.ix / kTileSide, column.iy / kTileSide, *out.start_);
    const auto i = static_cast<std::size_t>(index_in_tile(column.ix, column.iy));
    // Most tiles have no loose soil and store no depths.
    if (!tile.loose) {
      tile.loose = std::make_shared<std::array<float, kTileColumns>>();
      tile.loose->fill(0);
    }
    tile.height[i] = column.top;
    tile.soil[i] = column.soil;
    tile.specific_volume[i] = column.specific_volume;
    (*tile.loose)[i] = static_cast<float>(column.depth);
  }
  // From here on this view is immutable like the one it came from.
  out.table_.freeze();
  return out;
}

}  // namespace navvy::heightfield
