// SPDX-License-Identifier: Apache-2.0
// Dense maps of a part of the ground, for pictures, planners and exports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heightfield/ground.h"

namespace navvy::heightfield {

enum class MapLayer {
  kElevation,  ///< height in W [m]
  kChange,     ///< height now minus height at the start [m]
  kSlope,      ///< angle from the horizontal [rad], central differences between columns
  kNormalX,    ///< unit normal, components in W
  kNormalY,
  kNormalZ,
  kSoil  ///< index of the surface soil
};

/// All names, in the order of the enumeration: elevation, change, slope, normal_x, normal_y, normal_z, soil.
const std::vector<std::string>& map_layer_names();
/// @throws InputError listing the names when there is none like it.
MapLayer map_layer(const std::string& name);

/// One layer over `rect`, which is cut to the site. Column (0, 0) of the view has least x and least y, x fastest.
struct MapView {
  CellRect rect;
  double cell = 0;             ///< [m]
  Vec2 origin = Vec2::Zero();  ///< W of the view's lower-left corner [m]
  std::uint64_t sequence = 0;  ///< of the ground when it was taken; ask `changed_since` with it
  std::vector<float> values;
  int nx() const { return rect.x1 - rect.x0; }
  int ny() const { return rect.y1 - rect.y0; }
  float at(int ix, int iy) const { return values[static_cast<std::size_t>(iy) * nx() + ix]; }
};
MapView map_view(const Ground& ground, MapLayer layer, CellRect rect);
/// Of the whole site. @throws InputError when the site has more than 2^28 columns.
MapView map_view(const Ground& ground, MapLayer layer);

}  // namespace navvy::heightfield
