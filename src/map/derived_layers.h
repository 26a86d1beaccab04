// SPDX-License-Identifier: Apache-2.0
// Layers that are computed from elevation only: pure functions of nearby columns, so that updating
// a part of a map is bit-identical to computing all of it.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "core/math.h"
#include "heightfield/cell_rect.h"

namespace navvy::map {

/// Limits of the ground that a machine can drive on. Ground that reaches a limit has traversability
/// 0.
struct TraversabilityLimits {
  /// Inclination of the plane through the window at which the ground stops being drivable [rad].
  /// The default is typical but unverified (U).
  double slope = radians(30);
  /// Step height at which the ground stops being drivable [m]. The default, about a third of the
  /// diameter of an excavator's wheel, is typical but unverified (U).
  double step_height = 0.30;
  /// Rms roughness at which the ground stops being drivable [m]. The default is typical but
  /// unverified (U).
  double roughness = 0.10;
  /// Half the side of the square window in which plane, step height and roughness are computed [m].
  /// The window extends at least one column to each side.
  double window = 0.20;
  /// Checks the limits for columns with edge `cell` [m]. @throws InputError naming a value that is
  /// not finite and positive, or a window of more than 64 columns to each side.
  void require_valid(double cell) const;
  /// Returns the number of columns to each side that the window covers, for columns with edge
  /// `cell` [m]: from 1 to 64.
  int reach(double cell) const;
};

/// Heights of a rectangle of columns, including a margin around the columns of interest.
struct ElevationPatch {
  /// Columns of the patch, including the margin. They may lie outside the site.
  heightfield::CellRect rect;
  /// Edge length of a column [m].
  double cell = 0;
  /// Heights as world z [m], x fastest; NaN outside the site.
  std::vector<float> z;
  /// Heights of bodies above the surface [m], in the order of `z`; empty if there are none.
  std::vector<float> occupied = {};
  /// Returns the height of site column (ix, iy), as world z [m]; NaN if it is unknown. The column
  /// must lie in the patch.
  float at(int ix, int iy) const { return z[index(ix, iy)]; }
  /// Returns the index of site column (ix, iy) in `z`. The column must lie in the patch.
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy - rect.y0) * static_cast<std::size_t>(rect.x1 - rect.x0) +
           static_cast<std::size_t>(ix - rect.x0);
  }
};

/// Returns the gradient of the surface in column (ix, iy), along x and y [-]. It uses central
/// differences, and one-sided differences next to unknown columns. NaN if the column's elevation is
/// unknown; a component is NaN if neither neighbour on its axis is known. The column must lie at
/// least one column inside the patch.
Vec2 gradient_at(const ElevationPatch& patch, int ix, int iy);
/// Returns the angle of the surface from the horizontal in column (ix, iy) [rad]; NaN if a
/// component of `gradient_at` is NaN. The column must lie at least one column inside the patch.
float slope_at(const ElevationPatch& patch, int ix, int iy);
/// Returns the largest height difference between two columns that share an edge, within `reach`
/// columns of column (ix, iy) [m]; NaN if the elevation of (ix, iy) is unknown. The column must lie
/// at least `reach` columns inside the patch.
float step_height_at(const ElevationPatch& patch, int ix, int iy, int reach);
/// Least-squares plane of the surface around a column; both values are NaN if there is none.
struct PlaneFit {
  /// Angle of the plane from the horizontal [rad].
  float inclination = std::numeric_limits<float>::quiet_NaN();
  /// Rms distance of the surface from the plane, along z [m].
  float roughness = std::numeric_limits<float>::quiet_NaN();
};
/// Returns the plane through the columns within `reach` columns of column (ix, iy). There is none
/// if the elevation of (ix, iy) is unknown, or if the known columns do not determine a plane. The
/// column must lie at least `reach` columns inside the patch.
PlaneFit plane_at(const ElevationPatch& patch, int ix, int iy, int reach);
/// Returns the traversability of ground with the given inclination [rad], step height [m] and
/// roughness [m]: the mean of 1 - value / limit of the three values. 0 if any value reaches its
/// limit, NaN if any value is NaN. The inclination is that of the plane, not the slope of a column:
/// the sides of a rut are steep, but lower than a step that stops a machine.
float traversability(float inclination, float step_height, float roughness,
                     const TraversabilityLimits& limits);

/// Computes the layers of one column that depend on nearby elevations. Values that several layers
/// need are computed only once.
class Surround {
 public:
  /// Represents column (ix, iy) of `patch`. The patch and the limits must outlive this object;
  /// `reach` must be limits.reach(patch.cell).
  Surround(const ElevationPatch& patch, int ix, int iy, const TraversabilityLimits& limits,
           int reach)
      : patch_(patch), limits_(limits), ix_(ix), iy_(iy), reach_(reach) {}

  /// Returns the limits of the map.
  const TraversabilityLimits& limits() const { return limits_; }
  /// Returns the angle of the surface from the horizontal at the column [rad]; NaN if it is
  /// unknown.
  float slope();
  /// Returns the largest height difference between neighbouring columns within the window around
  /// the column [m]; NaN if the column's elevation is unknown.
  float step_height();
  /// Returns the least-squares plane of the surface within the window around the column.
  const PlaneFit& plane();
  /// Returns true if a body higher than the limit of steps stands on the column.
  bool blocked() const {
    return !patch_.occupied.empty() &&
           static_cast<double>(patch_.occupied[patch_.index(ix_, iy_)]) > limits_.step_height;
  }
  /// Returns one component of the unit upward normal, in world axes: x, y or z for axis 0, 1 or 2.
  float normal(int axis) const;

 private:
  /// Heights around the column.
  const ElevationPatch& patch_;
  /// Limits of the map.
  const TraversabilityLimits& limits_;
  /// Indices of the column, and window size in columns to each side.
  int ix_, iy_, reach_;
  /// Step height [m] of the column, and its plane; no value until they are first requested.
  std::optional<float> step_height_;
  std::optional<PlaneFit> plane_;
};

/// Returns `rect` extended by `by` columns on each side. The result may extend beyond the site.
inline heightfield::CellRect grown(const heightfield::CellRect& rect, int by) {
  return {rect.x0 - by, rect.y0 - by, rect.x1 + by, rect.y1 + by};
}

/// Calls `work(block)` for blocks of at most 256 x 256 columns that together cover `rect`. The
/// heights of a block with its margin fit into a processor cache.
template <class Work>
void for_each_block(const heightfield::CellRect& rect, const Work& work) {
  constexpr int kBlock = 256;
  for (int y0 = rect.y0; y0 < rect.y1; y0 += kBlock)
    for (int x0 = rect.x0; x0 < rect.x1; x0 += kBlock)
      work(heightfield::CellRect{x0, y0, std::min(x0 + kBlock, rect.x1),
                                 std::min(y0 + kBlock, rect.y1)});
}

/// Calls `work(ix, iy, surround)` for every column of `block`. The patch must extend at least
/// limits.reach(patch.cell) columns beyond the block on each side.
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
