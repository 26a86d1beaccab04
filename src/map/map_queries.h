// SPDX-License-Identifier: Apache-2.0
// What planners ask a map at a place. All are const, allocate little or nothing, and may be asked
// by any number of threads at a time.
#pragma once

#include <optional>

#include "core/math.h"
#include "map/terrain_map.h"

namespace navvy::map {

/// Of the column that holds W (x, y); NaN where it is unknown, outside the site, and for a layer
/// the map lacks.
float value(const TerrainMap& map, MapLayer layer, double x, double y);

// Of the surface that is bilinear between column centres and level from the outermost centres to
// the site's edge.
/// Height in W [m]; NaN outside the site and where one of the columns about the place is unknown.
double height(const TerrainMap& map, double x, double y);
/// Unit upward normal in W; nothing where `height` has no answer.
std::optional<Vec3> normal(const TerrainMap& map, double x, double y);
/// Angle of that surface from the horizontal [rad]; NaN where `height` has no answer. The layer
/// `slope` is a column's, over the width of three.
double slope(const TerrainMap& map, double x, double y);

enum class Sight {
  kFree,    ///< nothing of the surface stands above the segment
  kHidden,  ///< something does; touching is not enough
  kUnsure   ///< free as far as is known, but the segment crosses unknown columns or leaves the site
};
/// Whether the straight segment between two points in W is above the surface all along. Exact for
/// the bilinear surface. Costs some 10 ns a column crossed.
Sight line_of_sight(const TerrainMap& map, const Vec3& p, const Vec3& q);

}  // namespace navvy::map
