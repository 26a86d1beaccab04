// SPDX-License-Identifier: Apache-2.0
// What a machine stands or rolls on the ground with, as columns see it
// [docs/exchange.md, footings].
#pragma once

#include <span>
#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"

namespace navvy::soil {

/// A wheel, or part of a belt: a rim that is round in the plane of its way and as wide as its axle
/// is long. A belt runs straight between its rollers, so its rim's middle is a line instead of a
/// point.
struct SupportArea {
  Vec3 p_W = Vec3::Zero();       ///< middle of the axle, or of the line of axles [m]
  Vec3 ahead_W = Vec3::UnitX();  ///< unit, along the line of axles; of a wheel level
  Vec3 left_W = Vec3::UnitY();   ///< unit, along the axle
  double radius = 0;             ///< [m]
  double half_width = 0;         ///< [m]
  double half_run = 0;           ///< from the middle to the outermost axle, 0 of a wheel [m]
  Vec3 v_W = Vec3::Zero();       ///< of the middle [m/s]
  /// How far its load presses it flat: it bears on ground so high above its rim [m].
  double give = 0;
  double ready = 0;  ///< the ground must be there so long before the rim comes [s]
};

/// A footing over the columns of a ground, for one check of the exchange.
class SupportPlacement {
 public:
  /// `interval` [s]: until the next check.
  SupportPlacement(const SupportArea& footing, const heightfield::Ground& ground, double interval);

  /// Columns that it may concern; may reach beyond the site.
  const heightfield::CellRect& rect() const { return rect_; }
  /// Whether the rim stands on ground of this `height` [m] in the column, or comes to within a
  /// quarter of a cell of it before the ground can be looked at again. The columns around count
  /// with it.
  bool meets(int ix, int iy, double height) const;
  /// Height [m] to which the ground under the rim may be raised as it stands now; infinite beside
  /// it.
  double room(int ix, int iy) const;

 private:
  Vec2 along_across(int ix, int iy) const;
  /// Height of the rim's underside [m] over a place `along` and `across` of its middle, widened by
  /// so much all around; infinite beside it.
  double underside(double along, double across, double widened) const;

  SupportArea footing_;
  Vec2 origin_, ahead_, left_;
  double cell_, way_, fall_;
  heightfield::CellRect rect_;
};

std::vector<SupportPlacement> support_placements(std::span<const SupportArea> support_areas,
                                                 const heightfield::Ground& ground,
                                                 double interval);

}  // namespace navvy::soil
