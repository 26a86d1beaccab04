// SPDX-License-Identifier: Apache-2.0
// Cut and fill volumes in a polygon.
#pragma once

#include <span>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Volumes between the ground and a reference surface over an area. `fill` is in the present state
/// of the soil.
struct CutFill {
  /// Area of the polygon on known columns [m2].
  double area = 0;
  /// Area where elevation or reference is unknown, or outside the site [m2].
  double unknown_area = 0;
  /// Volume by which the reference lies above the elevation: bank volume where the reference was
  /// bank [m3].
  double cut = 0;
  /// Volume by which the elevation lies above the reference, in its present state [m3].
  double fill = 0;
  /// The same as bank volume, by the density at the surface; NaN where the map lacks density or
  /// soil [m3].
  double fill_bank = 0;
  /// Part of `fill` that consists of particles; NaN where the map lacks loose_depth [m3].
  double active = 0;
};

/// Integrates elevation minus `reference` (kElevationStart: soil moved; kTarget: soil still to be
/// moved) over a simple polygon in W (x, y) [m]. The polygon is closed implicitly, may be wound
/// either way and need not be convex. A column counts with the exact share of its square inside the
/// polygon. Costs some 20 ns per column inside, more at the border.
/// @throws InputError for fewer than three corners, a corner that is not finite, or a reference
/// that is not a height.
CutFill cut_and_fill(const TerrainMap& map, std::span<const Vec2> polygon,
                     MapLayer reference = MapLayer::kElevationStart);

}  // namespace navvy::map
