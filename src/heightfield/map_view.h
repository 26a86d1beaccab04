// SPDX-License-Identifier: Apache-2.0
// Dense maps of a part of the terrain, for pictures, planners and exports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// A number that every column has. One row of the table in map_layers.cpp; a new layer is a row
/// there and its function, and nothing else.
struct MapLayer {
  std::string name;
  std::string unit;                                                   ///< "m", "rad", "-"
  std::string meaning;                                                ///< one line for a person
  double (*value)(const Terrain& terrain, int ix, int iy) = nullptr;  ///< of a column of the site
};

/// All layers: elevation, change, slope, normal_x, normal_y, normal_z, soil, specific_volume,
/// loose_depth, awake.
const std::vector<MapLayer>& map_layers();
/// @throws InputError listing the names when there is none like it.
const MapLayer& map_layer(const std::string& name);

/// One layer over `rect`, which is cut to the site. Column (0, 0) of the view has least x and least
/// y, x fastest.
struct MapView {
  CellRect rect;
  double cell = 0;             ///< [m]
  Vec2 origin = Vec2::Zero();  ///< W of the view's lower-left corner [m]
  std::uint64_t sequence = 0;  ///< of the terrain it is a view of
  std::vector<float> values;   ///< nx() x ny(), in the layer's unit
  /// Columns along x and y; 0 where the rectangle lies outside the site.
  int nx() const { return rect.x1 - rect.x0; }
  int ny() const { return rect.y1 - rect.y0; }
  /// Of column (ix, iy) of the view.
  float at(int ix, int iy) const {
    return values[static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx()) +
                  static_cast<std::size_t>(ix)];
  }
};
/// Computes every column anew; costs 10 to 60 ns a column. @throws InputError when the rectangle
/// has more than 2^28 columns or no layer is called `layer`.
MapView map_view(const Terrain& terrain, const std::string& layer, const CellRect& rect);
/// Of the whole site. @throws like the other one.
MapView map_view(const Terrain& terrain, const std::string& layer);

}  // namespace navvy::heightfield
