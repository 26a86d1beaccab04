// SPDX-License-Identifier: Apache-2.0
// Queries of a map at world positions. They do not change the map, allocate little or no memory,
// and may run in any number of threads at the same time.
#pragma once

#include <optional>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Returns the value of `layer` in the column that contains world position (x, y) [m]. NaN if the
/// value is unknown, the position is outside the site, or the map does not contain the layer.
float value(const TerrainMap& map, MapLayer layer, double x, double y);

/// Returns the height of the surface at world position (x, y) [m], as world z [m]. The surface is
/// bilinear between column centres, and level from the outermost centres to the edge of the site.
/// NaN outside the site, and if the elevation of one of the surrounding columns is unknown.
double height(const TerrainMap& map, double x, double y);
/// Returns the unit upward normal, in world axes, of the bilinear surface at world position (x, y)
/// [m]. Returns no value if `height` is NaN there.
std::optional<Vec3> normal(const TerrainMap& map, double x, double y);
/// Returns the angle from the horizontal of the bilinear surface at world position (x, y) [rad];
/// NaN if `height` is NaN there. The map layer `slope` differs: it has one value per column,
/// computed from three columns along each axis.
double slope(const TerrainMap& map, double x, double y);

/// Result of a line-of-sight query between two points.
enum class Sight {
  /// The surface does not rise above the line segment.
  kFree,
  /// The surface rises above the line segment. Touching it is not enough.
  kHidden,
  /// The known surface does not rise above the line segment, but the segment crosses unknown
  /// columns or leaves the site.
  kUnsure
};
/// Tests if the straight line segment between the world points `p` and `q` [m] is free of ground.
/// The result is exact for the bilinear surface. Takes about 10 ns per column crossed. Points that
/// are not finite give Sight::kUnsure.
Sight line_of_sight(const TerrainMap& map, const Vec3& p, const Vec3& q);

}  // namespace navvy::map
