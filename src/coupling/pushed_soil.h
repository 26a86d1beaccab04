// SPDX-License-Identifier: Apache-2.0
// Soil that flows out from under a wheel or track and raises the edges of its rut.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "heightfield/layered_ground.h"

namespace navvy::coupling {

/// Holds soil taken from under wheels and tracks until it is laid down beside them.
///
/// The soil is laid down along a strip as wide as the tyre or track that displaced it: the wedge
/// that Prandtl's mechanism lifts in soil without friction [Prandtl 1920]. The strip starts beside
/// the wheel at the first column that carries no load. The soil is loose and remoulded, as all soil
/// that slides. Masses are whole mass quanta: every quantum that leaves a column arrives in another
/// one.
class PushedSoil {
 public:
  /// Position of a column under a tyre or track.
  struct Place {
    int ix = 0, iy = 0;
    /// Unit vector to the left of the direction of travel.
    Vec2 across = Vec2::UnitY();
    /// Distance to the left of the middle line of wheel or track [m].
    double left = 0;
    /// Distance from the middle line to the outside of the wheel (twins included) or track [m].
    double reach = 0;
    /// Width of one tyre or track [m].
    double width = 0;
    /// Share of the column that is under that tyre or track [-].
    double covered = 1;
  };

  /// Starts empty. The ground must outlive this object.
  explicit PushedSoil(heightfield::Ground& ground) : ground_(ground) {}

  /// Returns the share of a column under a tyre or track whose middle is `off` [m] away. Columns
  /// beside it are compacted as well, since the tyre senses the ground between two columns, but
  /// they lose no soil.
  static double covered(double off, double width, double cell);

  /// Takes the covered share of the uppermost `depth` [m] of a column.
  void take(const Place& place, double depth);
  /// Lays all soil down in the order in which it was taken. Columns for which `loaded` is true
  /// receive none. Soil without a target, between the tyre and the site's edge, is compacted into
  /// the column it came from.
  void deposit_down(const std::function<bool(int ix, int iy)>& loaded);

 private:
  /// Soil taken from one column.
  struct Load {
    Place place;
    /// Soil layers, bottom first.
    std::vector<heightfield::SoilLayer> layers;
  };
  /// Column of the strip and the share of it [-] inside the strip.
  struct Strip {
    Vec2i column;
    double share;
  };
  /// Returns the strip on one side: `sign` 1 left, -1 right. Empty if there is no space.
  std::vector<Strip> strip(const Place& from, double sign,
                           const std::function<bool(int, int)>& loaded) const;
  /// Deposits a layer on the columns of a strip by their shares.
  void spread(const heightfield::SoilLayer& layer, const std::vector<Strip>& strip);

  heightfield::Ground& ground_;
  std::vector<Load> loads_;
};

}  // namespace navvy::coupling
