// SPDX-License-Identifier: Apache-2.0
// Layers that follow from elevation alone: a pure function of the columns nearby, so that a part of
// a map may be brought up to date and comes out as if all of it had been.
#pragma once

#include <vector>

#include "heightfield/cell_rect.h"
#include "planner/terrain_map.h"

namespace navvy::planner {

/// What a machine can drive on. A value at its limit is bad, zero is best.
struct TraversabilityLimits {
  double slope = radians(30);  ///< [rad] (U)
  double step_height = 0.30;   ///< [m] (U): about a third of the diameter of an excavator's wheel
  double roughness = 0.10;     ///< [m] (U)
  /// Half the side of the square that step height and roughness look at [m]; at least one column.
  double window = 0.20;
  /// @throws InputError naming the number that is not finite and above zero, or a window of more
  /// than 64 columns.
  void require_valid(double cell) const;
  /// Columns to either side that a value looks at.
  int reach(double cell) const;
};

/// Elevation of a rectangle and a margin round it; unknown outside the site.
struct ElevationPatch {
  heightfield::CellRect rect;  ///< with the margin
  double cell = 0;             ///< [m]
  std::vector<float> z;        ///< x fastest
  float at(int ix, int iy) const {
    return z[static_cast<std::size_t>(iy - rect.y0) * static_cast<std::size_t>(rect.x1 - rect.x0) +
             static_cast<std::size_t>(ix - rect.x0)];
  }
};

// Of column (ix, iy) of the site, at least `reach` columns within the patch; unknown where its
// elevation is.
/// Central differences, one-sided beside unknown columns and the edge; unknown where an axis has no
/// neighbour.
float slope_at(const ElevationPatch& patch, int ix, int iy);
/// Largest |z_a - z_b| of two edge neighbours a, b that both lie in the window.
float step_height_at(const ElevationPatch& patch, int ix, int iy, int reach);
/// Rms of the residuals of the least-squares plane through the window; unknown where known columns
/// span no plane.
float roughness_at(const ElevationPatch& patch, int ix, int iy, int reach);
/// Mean of 1 - value / limit of the three; 0 where one of them reaches its limit, unknown where one
/// is unknown.
float traversability(float slope, float step_height, float roughness,
                     const TraversabilityLimits& limits);

}  // namespace navvy::planner
