// SPDX-License-Identifier: Apache-2.0
#include "heightfield/map_view.h"

#include <algorithm>

#include "core/error.h"
#include "heightfield/tiles.h"

namespace navvy::heightfield {
namespace {

constexpr std::int64_t kMostColumns = std::int64_t{1} << 28;  // 1 GiB of floats

// Normal at a column from its neighbours; one-sided at the edge of the site.
Vec3 normal_at(const Ground& ground, int ix, int iy) {
  const int x0 = std::max(ix - 1, 0), x1 = std::min(ix + 1, ground.nx() - 1);
  const int y0 = std::max(iy - 1, 0), y1 = std::min(iy + 1, ground.ny() - 1);
  const double dx = x1 > x0 ? (ground.height(x1, iy) - ground.height(x0, iy)) / ((x1 - x0) * ground.cell()) : 0;
  const double dy = y1 > y0 ? (ground.height(ix, y1) - ground.height(ix, y0)) / ((y1 - y0) * ground.cell()) : 0;
  return Vec3(-dx, -dy, 1).normalized();
}

double value_at(const Ground& ground, MapLayer layer, int ix, int iy) {
  switch (layer) {
    case MapLayer::kElevation:
      return ground.height(ix, iy);
    case MapLayer::kChange:
      return ground.height(ix, iy) - ground.start_height(ix, iy);
    case MapLayer::kSlope: {
      const Vec3 n = normal_at(ground, ix, iy);
      return std::atan2(n.head<2>().norm(), n.z());
    }
    case MapLayer::kNormalX:
      return normal_at(ground, ix, iy).x();
    case MapLayer::kNormalY:
      return normal_at(ground, ix, iy).y();
    case MapLayer::kNormalZ:
      return normal_at(ground, ix, iy).z();
    case MapLayer::kSoil:
      return ground.surface_soil(ix, iy);
  }
  return 0;
}

}  // namespace

const std::vector<std::string>& map_layer_names() {
  static const std::vector<std::string> names = {"elevation", "change",   "slope", "normal_x",
                                                 "normal_y",  "normal_z", "soil"};
  return names;
}

MapLayer map_layer(const std::string& name) {
  const auto& names = map_layer_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<MapLayer>(found - names.begin());
  std::string all;
  for (const std::string& each : names) all += (all.empty() ? "" : ", ") + each;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "map layer", name, "no such layer", "one of " + all});
}

MapView map_view(const Ground& ground, MapLayer layer, CellRect rect) {
  rect = {std::max(rect.x0, 0), std::max(rect.y0, 0), std::min(rect.x1, ground.nx()), std::min(rect.y1, ground.ny())};
  MapView view;
  view.cell = ground.cell();
  view.sequence = ground.sequence();
  if (rect.empty()) return view;
  view.rect = rect;
  view.origin = ground.origin() + ground.cell() * Vec2(rect.x0, rect.y0);
  const std::int64_t columns = static_cast<std::int64_t>(view.nx()) * view.ny();
  if (columns > kMostColumns)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "map view", std::to_string(columns) + " columns",
                           "at most 2^28 columns", "ask for a smaller rectangle"});
  view.values.resize(static_cast<std::size_t>(columns));
  // Tile by tile, so that the ground computes each untouched tile about once.
  for (int by = rect.y0; by < rect.y1; by = (by / kTileSide + 1) * kTileSide)
    for (int bx = rect.x0; bx < rect.x1; bx = (bx / kTileSide + 1) * kTileSide)
      for (int iy = by; iy < std::min((by / kTileSide + 1) * kTileSide, rect.y1); ++iy)
        for (int ix = bx; ix < std::min((bx / kTileSide + 1) * kTileSide, rect.x1); ++ix)
          view.values[static_cast<std::size_t>(iy - rect.y0) * view.nx() + (ix - rect.x0)] =
              static_cast<float>(value_at(ground, layer, ix, iy));
  return view;
}

MapView map_view(const Ground& ground, MapLayer layer) {
  return map_view(ground, layer, CellRect{0, 0, ground.nx(), ground.ny()});
}

}  // namespace navvy::heightfield
