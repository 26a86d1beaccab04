// SPDX-License-Identifier: Apache-2.0
// Layers that follow from elevation alone: pure functions of the columns nearby, so that updating a
// part of a map is bit-identical to computing all of it.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/math.h"
#include "heightfield/cell_rect.h"

namespace navvy::map {

/// Limits of what a machine can drive on. A value at its limit counts as bad, zero as best.
struct TraversabilityLimits {
  /// Steepest slope [rad] (U).
  double slope = radians(30);
  /// Highest step [m] (U): about a third of the diameter of an excavator's wheel.
  double step_height = 0.30;
  /// Largest rms roughness [m] (U).
  double roughness = 0.10;
  /// Half the side of the square over which step height and roughness are computed [m]; at least
  /// one column.
  double window = 0.20;
  /// @throws InputError that names the number that is not finite and positive, or a window of more
  /// than 64 columns of `cell` [m].
  void require_valid(double cell) const;
  /// Returns the number of columns to either side that a value depends on.
  int reach(double cell) const;
};

/// Elevation of a rectangle of columns with a margin around it; unknown outside the site.
struct ElevationPatch {
  /// Columns of the patch, margin included.
  heightfield::CellRect rect;
  /// Edge of a column [m].
  double cell = 0;
  /// Heights in W [m], x fastest.
  std::vector<float> z;
  /// Returns the height of column (ix, iy) of the site, which must lie in the patch [m].
  float at(int ix, int iy) const {
    return z[static_cast<std::size_t>(iy - rect.y0) * static_cast<std::size_t>(rect.x1 - rect.x0) +
             static_cast<std::size_t>(ix - rect.x0)];
  }
};

// Each function takes a column (ix, iy) of the site at least `reach` columns inside the patch and
// returns NaN where the elevation of that column is unknown.
/// Returns the gradient of the surface [-]: central differences, one-sided beside unknown columns
/// and at the edge; NaN where an axis has no known neighbour.
Vec2 gradient_at(const ElevationPatch& patch, int ix, int iy);
/// Returns the angle of that gradient from the horizontal [rad].
float slope_at(const ElevationPatch& patch, int ix, int iy);
/// Returns the largest |z_a - z_b| of two edge neighbours a, b that both lie in the window [m].
float step_height_at(const ElevationPatch& patch, int ix, int iy, int reach);
/// Returns the rms of the residuals of the least-squares plane through the window [m]; NaN where
/// the known columns do not determine a plane.
float roughness_at(const ElevationPatch& patch, int ix, int iy, int reach);
/// Returns the mean of 1 - value / limit of the three; 0 where one of them reaches its limit, NaN
/// where one is NaN.
float traversability(float slope, float step_height, float roughness,
                     const TraversabilityLimits& limits);

/// One column and the elevation around it. Computes what several layers share only once.
class Surround {
 public:
  /// The patch and the limits must outlive it; `reach` is limits.reach(patch.cell).
  Surround(const ElevationPatch& patch, int ix, int iy, const TraversabilityLimits& limits,
           int reach)
      : patch_(patch), limits_(limits), ix_(ix), iy_(iy), reach_(reach) {}

  /// Returns the limits of the map.
  const TraversabilityLimits& limits() const { return limits_; }
  /// Angle from the horizontal [rad].
  float slope();
  /// Largest step within the window [m].
  float step_height();
  /// Rms roughness within the window [m].
  float roughness();
  /// Component 0, 1 or 2 of the unit upward normal in W.
  float normal(int axis) const;

 private:
  const ElevationPatch& patch_;
  const TraversabilityLimits& limits_;
  int ix_, iy_, reach_;
  std::optional<float> slope_, step_height_, roughness_;
};

/// Returns `rect` grown by `by` columns to each side, also beyond the site.
inline heightfield::CellRect grown(const heightfield::CellRect& rect, int by) {
  return {rect.x0 - by, rect.y0 - by, rect.x1 + by, rect.y1 + by};
}

/// Calls `work(block)` for blocks of at most 256 x 256 columns that cover `rect`: their elevation
/// with its margin fits a processor's cache.
template <class Work>
void for_each_block(const heightfield::CellRect& rect, const Work& work) {
  constexpr int kBlock = 256;
  for (int y0 = rect.y0; y0 < rect.y1; y0 += kBlock)
    for (int x0 = rect.x0; x0 < rect.x1; x0 += kBlock)
      work(heightfield::CellRect{x0, y0, std::min(x0 + kBlock, rect.x1),
                                 std::min(y0 + kBlock, rect.y1)});
}

/// Calls `work(ix, iy, surround)` for every column of `block`, around which `patch` has a margin of
/// limits.reach(patch.cell) columns.
template <class Work>
void for_each_surround(const ElevationPatch& patch, const heightfield::CellRect& block,
                       const TraversabilityLimits& limits, const Work& work) {
  const int reach = limits.reach(patch.cell);
  for (int iy = block.y0; iy < block.y1; ++iy)
    for (int ix = block.x0; ix < block.x1; ++ix) {
      Surround surround(patch, ix, iy, limits, reach);
      work(ix, iy, surround);
    }
}

}  // namespace navvy::map
