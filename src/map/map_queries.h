// SPDX-License-Identifier: Apache-2.0
// Queries of a map at a place. All are const, allocate little or nothing, and may run in any number
// of threads at a time.
#pragma once

#include <optional>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Returns the value of the column that holds W (x, y); NaN where it is unknown, outside the site,
/// and for a layer that the map does not hold.
float value(const TerrainMap& map, MapLayer layer, double x, double y);

/// Returns the height in W [m] of the surface that is bilinear between the centres of columns and
/// level from the outermost centres to the edge of the site; NaN outside the site and where a
/// column around the place is unknown.
double height(const TerrainMap& map, double x, double y);
/// Returns the unit upward normal of that surface in W; nothing where `height` is NaN.
std::optional<Vec3> normal(const TerrainMap& map, double x, double y);
/// Returns the angle of that surface from the horizontal [rad]; NaN where `height` is NaN. The
/// layer `slope` belongs to a column instead and spans three columns.
double slope(const TerrainMap& map, double x, double y);

/// Result of a line-of-sight query.
enum class Sight {
  /// The surface stays below the segment.
  kFree,
  /// The surface rises above the segment; touching it is not enough.
  kHidden,
  /// The segment is free as far as is known, but crosses unknown columns or leaves the site.
  kUnsure
};
/// Tests whether the straight segment between two points in W [m] stays above the surface. Exact
/// for the bilinear surface. Costs some 10 ns per column crossed.
Sight line_of_sight(const TerrainMap& map, const Vec3& p, const Vec3& q);

}  // namespace navvy::map
