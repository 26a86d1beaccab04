// SPDX-License-Identifier: Apache-2.0
// Dense maps are made column by column from the layer's function; what a layer is stands in
// map_layers.cpp.
#include "heightfield/map_view.h"

#include <algorithm>

#include "core/error.h"

namespace navvy::heightfield {
namespace {

constexpr std::int64_t kMostColumns = std::int64_t{1} << 28;  // 1 GiB of floats

}  // namespace

MapView map_view(const Terrain& terrain, const std::string& layer, const CellRect& wanted) {
  const auto value = map_layer(layer).value;
  const CellRect rect = wanted.cut(terrain.site_rect());
  MapView view;
  view.cell = terrain.cell();
  view.sequence = terrain.sequence();
  if (rect.empty()) return view;
  view.rect = rect;
  view.origin = terrain.origin() + terrain.cell() * Vec2(rect.x0, rect.y0);
  if (rect.area() > kMostColumns)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "map view",
                           std::to_string(rect.area()) + " columns", "at most 2^28 columns",
                           "ask for a smaller rectangle"});
  view.values.resize(static_cast<std::size_t>(rect.area()));
  // Tile by tile, so that of an untouched site larger than what is remembered each tile is computed
  // about once.
  for (int by = rect.y0; by < rect.y1; by = (by / kTileSide + 1) * kTileSide)
    for (int bx = rect.x0; bx < rect.x1; bx = (bx / kTileSide + 1) * kTileSide)
      for (int iy = by; iy < std::min((by / kTileSide + 1) * kTileSide, rect.y1); ++iy)
        for (int ix = bx; ix < std::min((bx / kTileSide + 1) * kTileSide, rect.x1); ++ix)
          view.values[static_cast<std::size_t>(iy - rect.y0) * static_cast<std::size_t>(view.nx()) +
                      static_cast<std::size_t>(ix - rect.x0)] =
              static_cast<float>(value(terrain, ix, iy));
  return view;
}

MapView map_view(const Terrain& terrain, const std::string& layer) {
  return map_view(terrain, layer, terrain.site_rect());
}

}  // namespace navvy::heightfield
