// SPDX-License-Identifier: Apache-2.0
// Soil that flows out from under a wheel or a belt and raises the edges of its rut.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "heightfield/layered_ground.h"

namespace navvy::coupling {

/// What was taken from under wheels and belts and is still to be laid down beside them.
///
/// It lies down along a strip as wide as what pressed it out, the wedge that Prandtl's mechanism
/// lifts in soil without friction [Prandtl 1920], beginning beside the wheel with the first column
/// that bears nothing. As all soil that slides it lies loose and remoulded. In whole units of mass:
/// what left one column arrives in others to the last unit.
class PushedSoil {
 public:
  /// How a column lies under what presses it.
  struct Place {
    int ix = 0, iy = 0;
    Vec2 across = Vec2::UnitY();  ///< unit, to the left of the way
    double left = 0;              ///< of the middle line of wheel or belt [m]
    /// From there to the outside of the wheel, twins and all, or of the belt [m].
    double reach = 0;
    double width = 0;    ///< of one tyre or belt [m]
    double covered = 1;  ///< share of the column that lies under that one [-]
  };

  /// The ground must outlive it.
  explicit PushedSoil(heightfield::Ground& ground) : ground_(ground) {}

  /// Share of a column `off` [m] the middle of a tyre or belt that lies under it. Columns beside it
  /// are pressed as well, as it feels the ground between two of them, but squeeze nothing out.
  static double covered(double off, double width, double cell);

  /// Takes of the uppermost `depth` [m] of a column what is covered.
  void take(const Place& place, double depth);
  /// Lays all of it down, in the order it was taken; columns that are `borne` receive nothing. What
  /// finds no place, between what presses and the site's edge, is pressed into the column it came
  /// from.
  void deposit_down(const std::function<bool(int ix, int iy)>& borne);

 private:
  struct Load {
    Place place;
    std::vector<heightfield::SoilLayer> layers;  ///< bottom first
  };
  /// A column of the strip and what share of it [-] lies in the strip.
  struct Strip {
    Vec2i column;
    double share;
  };
  /// To one side: `sign` 1 left, -1 right. Empty where there is no room.
  std::vector<Strip> strip(const Place& from, double sign,
                           const std::function<bool(int, int)>& borne) const;
  void spread(const heightfield::SoilLayer& layer, const std::vector<Strip>& strip);

  heightfield::Ground& ground_;
  std::vector<Load> loads_;
};

}  // namespace navvy::coupling
