// SPDX-License-Identifier: Apache-2.0
// Support areas: wheels and tracks of machines, and the columns of the ground under them
// [docs/exchange.md, support areas].
#pragma once

#include <span>
#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"

namespace navvy::soil {

/// A wheel, or part of a crawler track: a rim that is round in its plane of motion, with straight
/// sides. A track runs straight between its rollers, so its rim is a circle swept along the line
/// between the outermost axles.
struct SupportArea {
  /// Middle of the axle or, for a track, of the line through its axles, in W [m].
  Vec3 p_W = Vec3::Zero();
  /// Unit vector in W in the direction of rolling, along the line of axles; horizontal for a wheel.
  Vec3 ahead_W = Vec3::UnitX();
  /// Unit vector in W along the axle.
  Vec3 left_W = Vec3::UnitY();
  /// Radius of the rim [m].
  double radius = 0;
  /// Half the width of the rim [m].
  double half_width = 0;
  /// Distance from p_W to the outermost axle [m]; 0 for a wheel.
  double half_run = 0;
  /// Velocity of p_W in W [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Flattening of the tyre under load: the ground reaches this far above the lowest point of the
  /// round rim [m].
  double flattening = 0;
  /// Time before the arrival of the rim at which the ground must be ready [s].
  double ready = 0;
};

/// A support area in relation to the columns of a ground, for one check of the exchange.
class SupportPlacement {
 public:
  /// Computes the columns that the support area may reach. `interval`: time until the next check
  /// [s].
  SupportPlacement(const SupportArea& area, const heightfield::Ground& ground, double interval);

  /// Returns the rectangle of columns that the support area may touch before the next check,
  /// clipped to the site.
  const heightfield::CellRect& rect() const { return rect_; }
  /// Returns true if the rim, or its position at any time before the next check, comes within a
  /// quarter of a cell of ground of this `height` in W [m] in column (ix, iy). Columns next to the
  /// rim count as being under it.
  bool meets(int ix, int iy, double height) const;
  /// Returns the height in W up to which the ground in column (ix, iy) may rise without reaching
  /// into the rim at its current position [m]; infinite if the column is not under the rim.
  double height_limit(int ix, int iy) const;

 private:
  /// Returns the centre of column (ix, iy) relative to p_W in plan: along and across the direction
  /// of rolling [m].
  Vec2 along_across(int ix, int iy) const;
  /// Returns the height in W of the rim's underside [m] at the position `along`, `across` relative
  /// to p_W. The rim is enlarged in plan by `widened` [m] on all sides; the result is infinite
  /// outside it.
  double underside(double along, double across, double widened) const;

  /// Copy of the support area; its half width is at least one cell.
  SupportArea area_;
  /// Plan geometry: origin_ is the site's corner in W [m]; ahead_ and left_ are unit vectors along
  /// and across the direction of rolling.
  Vec2 origin_, ahead_, left_;
  /// cell_: edge of a cell; travel_: signed distance that the rim rolls ahead until the ground must
  /// be ready; fall_: distance that it may sink in that time, plus a quarter of a cell [m].
  double cell_, travel_, fall_;
  /// Columns that the support area may touch.
  heightfield::CellRect rect_;
};

/// Returns the placement of each support area, in the same order. `interval`: time until the next
/// check [s].
std::vector<SupportPlacement> support_placements(std::span<const SupportArea> support_areas,
                                                 const heightfield::Ground& ground,
                                                 double interval);

}  // namespace navvy::soil
