// SPDX-License-Identifier: Apache-2.0
// Displaced soil that flows out from under a wheel or track and raises the edges of its rut.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "heightfield/layered_ground.h"

namespace navvy::coupling {

/// Takes soil from under wheels and tracks, stores it, and deposits it beside them.
///
/// The soil from each column is deposited on a strip on either side of the wheel or track that
/// displaced it. A strip is as wide as the tyre or track, which is the width of the wedge that
/// Prandtl's mechanism raises in soil without friction [Prandtl 1920]. It begins at the first
/// column beside the wheel that carries no load. The deposited soil is loose and remoulded. Masses
/// are integers (mass quanta), so mass is conserved exactly.
class PushedSoil {
 public:
  /// Position of a column under a tyre or track.
  struct Place {
    /// Indices of the column in x and y direction.
    int ix = 0, iy = 0;
    /// Horizontal unit vector in W to the left of the direction of travel.
    Vec2 across = Vec2::UnitY();
    /// Distance of the column's centre to the left of the middle line of the wheel or track [m];
    /// negative to the right.
    double left = 0;
    /// Distance from the middle line to the outer edge of the wheel or track [m]. A wheel with twin
    /// tyres ends at the outer tyre.
    double reach = 0;
    /// Width of one tyre or of the track [m].
    double width = 0;
    /// Fraction of the column's width that is under the tyre or track [-].
    double covered = 1;
  };

  /// Makes an object that holds no soil. The ground must outlive it.
  explicit PushedSoil(heightfield::Ground& ground) : ground_(ground) {}

  /// Returns the fraction of a column's width [-] that is under a tyre or track. `off` is the
  /// distance of the column's centre from the middle of the tyre or track, `width` the width of the
  /// tyre or track, and `cell` the width of a column [m]. Columns just beside a tyre are compacted
  /// too, because the tyre interpolates the ground between columns, but they lose no soil.
  static double covered(double off, double width, double cell);

  /// Removes soil from the column at `place`: the fraction `Place::covered` of the uppermost
  /// `depth` [m].
  void take(const Place& place, double depth);
  /// Deposits all stored soil, in the order in which it was taken. Columns for which `loaded`
  /// returns true receive no soil. If no column can receive the soil, for example at the edge of
  /// the site, the soil is compacted into the column from which it came.
  void deposit_down(const std::function<bool(int ix, int iy)>& loaded);

 private:
  // Soil taken from one column.
  struct Load {
    // Column from which the soil was taken.
    Place place;
    // Soil layers, from bottom to top.
    std::vector<heightfield::SoilLayer> layers;
  };
  // One column of a strip, and the fraction of its width [-] that is inside the strip.
  struct Strip {
    Vec2i column;
    double share;
  };
  // Returns the columns of the strip that receives soil from the column `from`, on its left (`sign`
  // = 1) or right (-1) side. Empty if there is no suitable column.
  std::vector<Strip> strip(const Place& from, double sign,
                           const std::function<bool(int, int)>& loaded) const;
  // Distributes a layer of soil to the columns of a strip, in proportion to their fractions.
  void spread(const heightfield::SoilLayer& layer, const std::vector<Strip>& strip);

  // Ground from which soil is taken and to which it is returned.
  heightfield::Ground& ground_;
  // Stored soil, in the order in which it was taken.
  std::vector<Load> loads_;
};

}  // namespace navvy::coupling
