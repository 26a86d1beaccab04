// SPDX-License-Identifier: Apache-2.0
// The pit of a job on the columns of a site. Private to earthwork.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "control/job_planner.h"
#include "control/surface.h"
#include "heightfield/design_surface.h"

namespace navvy::earthwork {

/// A column of a pit that is to be dug.
struct PitColumn {
  Vec2 p = Vec2::Zero();  ///< centre in W [m]
  double floor = 0;       ///< height of the design in W [m]
  double top = 0;         ///< height of the ground in W [m]
};

/// Design surface of a pit on a site, and the ground in it.
class PitShape {
 public:
  /// Computes the design of `area` on the site of `surface`. @throws InputError as
  /// heightfield::design_of_area.
  PitShape(const scene::DesignArea& area, const control::SurfaceView& surface);

  /// Adds a border of this width [m] around the pit, whose floor is `skin` [m] above the ground at
  /// the start.
  void add_border(double width, double skin);

  /// Makes the shape of a heap on a rectangle: from then on its floor is `skin` [m] above the
  /// surface through the ground at the rectangle's four corners at the start, and its ground is the
  /// heap's present top.
  void cover_heap(double skin);

  /// Returns the height of the design at the point `p` in W [m]; NaN outside the pit.
  double floor(const Vec2& p) const;
  /// Returns the columns of the pit on the present ground.
  std::vector<PitColumn> columns() const;
  /// Returns the least and the greatest coordinate of its columns along a unit vector [m].
  std::pair<double, double> span(const Vec2& along) const;
  /// Returns its extent square to the longest edge of the polygon [m].
  double width() const;
  /// Returns the height of the ground in W at the first corner at the start [m].
  double ground() const { return ground_; }
  /// Returns the highest ground in the pit at the start [m].
  double rim() const { return rim_; }
  /// Returns the lowest height of the design [m].
  double lowest() const { return lowest_; }
  /// Returns the area of a column [m2].
  double column_area() const { return terrain_.cell() * terrain_.cell(); }
  /// Returns the distance between column centres [m].
  double cell() const { return terrain_.cell(); }
  /// Returns the commanded volume, what is left of it, and the deviation of the ground.
  control::JobVolume volume() const;
  /// Returns true if the pit is within `range` [m] of the point `p`.
  bool is_near(const Vec2& p, double range) const;

 private:
  const heightfield::Terrain& terrain_;
  std::vector<Vec2> polygon_;
  heightfield::DesignSurface design_;
  double ground_ = 0, lowest_ = 0, rim_ = 0;
};

}  // namespace navvy::earthwork
