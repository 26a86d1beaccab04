// SPDX-License-Identifier: Apache-2.0
// Support areas of machines, as columns see them [docs/exchange.md, support areas].
#pragma once

#include <span>
#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"

namespace navvy::soil {

/// A wheel, or part of a track: a rim that is round in its plane of motion and as wide as its axle
/// is long. A track runs straight between its rollers, so the middle of its rim is a line instead
/// of a point.
struct SupportArea {
  /// Middle of the axle, or of the line of axles [m].
  Vec3 p_W = Vec3::Zero();
  /// Unit vector along the line of axles; level for a wheel.
  Vec3 ahead_W = Vec3::UnitX();
  /// Unit vector along the axle.
  Vec3 left_W = Vec3::UnitY();
  /// Radius of the rim [m].
  double radius = 0;
  /// Half of its width [m].
  double half_width = 0;
  /// Distance from the middle to the outermost axle, 0 for a wheel [m].
  double half_run = 0;
  /// Velocity of the middle [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Flattening under load: it stands on ground this high above its rim [m].
  double flattening = 0;
  /// Time before the rim arrives at which the ground must be ready [s].
  double ready = 0;
};

/// A support area over the columns of a ground, for one check of the exchange.
class SupportPlacement {
 public:
  /// Places it over the columns. `interval`: time until the next check [s].
  SupportPlacement(const SupportArea& area, const heightfield::Ground& ground, double interval);

  /// Returns the columns that it may concern; they may lie outside the site.
  const heightfield::CellRect& rect() const { return rect_; }
  /// Returns true if the rim stands on ground of this `height` [m] in the column, or comes within a
  /// quarter of a cell of it before the next check. Neighbouring columns count, too.
  bool meets(int ix, int iy, double height) const;
  /// Returns the height [m] to which the ground under the rim may rise in its present position;
  /// infinite beside it.
  double height_limit(int ix, int iy) const;

 private:
  /// Returns the position of a column relative to the middle, along and across [m].
  Vec2 along_across(int ix, int iy) const;
  /// Returns the height of the rim's underside [m] at a position `along` and `across` from its
  /// middle, widened by `widened` on all sides; infinite beside it.
  double underside(double along, double across, double widened) const;

  SupportArea area_;
  Vec2 origin_, ahead_, left_;
  double cell_, travel_, fall_;
  heightfield::CellRect rect_;
};

std::vector<SupportPlacement> support_placements(std::span<const SupportArea> support_areas,
                                                 const heightfield::Ground& ground,
                                                 double interval);

}  // namespace navvy::soil
