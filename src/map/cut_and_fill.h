// SPDX-License-Identifier: Apache-2.0
// Cut and fill in a polygon.
#pragma once

#include <span>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// What an area holds against a reference surface, all in W. `fill` counts the soil as it lies.
struct CutFill {
  double area = 0;  ///< of the polygon on known columns [m2]
  /// Of the polygon where elevation or reference is unknown, or outside the site [m2].
  double unknown_area = 0;
  /// Reference above elevation: bank volume, where the reference was bank [m3].
  double cut = 0;
  double fill = 0;  ///< elevation above reference, as it lies [m3]
  /// Of that as bank, by density at the surface; NaN where the map lacks density or soil [m3].
  double fill_bank = 0;
  /// Of `fill`, what still lies as particles; NaN where the map lacks loose_depth [m3].
  double active = 0;
};

/// Elevation against `reference` (kElevationStart: what was moved; kTarget: what the design still
/// wants) over a simple polygon in W (x, y) [m], closed by itself, wound either way, not
/// necessarily convex. A column counts with the share of its square that lies within, exactly.
/// Costs some 20 ns a column within, more at the border.
/// @throws InputError for fewer than three corners, one that is not finite, or a reference that is
/// no height.
CutFill cut_and_fill(const TerrainMap& map, std::span<const Vec2> polygon,
                     MapLayer reference = MapLayer::kElevationStart);

}  // namespace navvy::map
