// SPDX-License-Identifier: Apache-2.0
// Cut and fill volumes within a polygon.
#pragma once

#include <span>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Volumes between the ground and a reference surface, within a polygon. The ground is above the
/// reference where there is fill, and below it where there is cut.
struct CutFill {
  /// Area within the polygon where elevation and reference are known [m2].
  double area = 0;
  /// Area within the polygon where elevation or reference is unknown, or that lies outside the site
  /// [m2].
  double unknown_area = 0;
  /// Volume between the ground and the reference surface where the ground is lower than the
  /// reference [m3]. This is a bank volume if the soil that was removed was undisturbed.
  double cut = 0;
  /// Volume between the ground and the reference surface where the ground is higher than the
  /// reference, in the current density state of the soil [m3].
  double fill = 0;
  /// The volume `fill` converted to bank volume, with the density at the surface of each column
  /// [m3]; NaN if the map has no density or soil layer.
  double fill_bank = 0;
  /// The part of `fill` that consists of loose particles [m3]; NaN if the map has no loose_depth
  /// layer.
  double active = 0;
};

/// Integrates elevation minus `reference` over a polygon of world (x, y) corners [m]. The reference
/// kElevationStart gives the soil moved so far; kTarget gives the soil still to be moved.
///
/// The polygon must not intersect itself. It is closed implicitly, may have either orientation, and
/// need not be convex. A column counts with the exact fraction of its area inside the polygon.
/// Takes about 20 ns per column inside the polygon, and more at its edges.
/// @throws InputError for fewer than three corners, a corner that is not finite, or a reference
/// other than kElevationStart or kTarget.
CutFill cut_and_fill(const TerrainMap& map, std::span<const Vec2> polygon,
                     MapLayer reference = MapLayer::kElevationStart);

}  // namespace navvy::map
