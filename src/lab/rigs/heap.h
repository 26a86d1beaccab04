// SPDX-License-Identifier: Apache-2.0
// What a pile of particles looks like from outside: its surface, volume, front and slope. Uses
// positions only, none of the solver's own density states.
#pragma once

#include <utility>
#include <vector>

#include "lab/lab_site.h"

namespace navvy::lab {

/// Positions of the particles that touch others: at least `neighbours` more in the 3 x 3 x 3 cells
/// around. The rest are single grains that fly or lie about.
std::vector<Vec3> in_contact(const Site& site, const std::vector<soil::Particle>& particles,
                             int neighbours = 8);

/// Heights over a rectangle, a quarter of a cell apart.
struct HeapSurface {
  Vec2 origin = Vec2::Zero();  ///< W of the first column's middle [m]
  double spacing = 0;          ///< [m]
  int nx = 0, ny = 0;
  std::vector<double> top;  ///< x fastest; `floor` where there is no soil [m]
  double floor = 0;

  double at(int ix, int iy) const { return top[static_cast<std::size_t>(ix + nx * iy)]; }
  Vec2 middle(int ix, int iy) const { return origin + spacing * Vec2(ix, iy); }
  double over(const Vec3& p) const;  ///< height over a particle of the pile, nearest column [m]
  double volume() const;             ///< between surface and floor [m3]
  double highest() const;
};

/// The surface a ball rolls on over the pile (closing by balls of 0.75 and 0.5 cells), a quarter of
/// a cell above the topmost particles as half the spacing of eight a cell demands.
HeapSurface surface_of(const std::vector<Vec3>& positions, double cell, double floor);

/// Least-squares line z = a + b x.
struct Line {
  double a = 0, b = 0;
};
Line fit_line(const std::vector<double>& x, const std::vector<double>& z);

/// Distance from `axis` [m] and mean height over the floor [m] in rings (`axisymmetric`) or in
/// strips along x of half a cell, strips over the middle third of the width.
std::vector<std::pair<double, double>> flank_profile(const HeapSurface& surface, const Vec2& axis,
                                                     bool axisymmetric, double cell);

/// Angle of the flank of a heap [rad]: least-squares line through its profile between 20 and 80 %
/// of its height.
double flank_angle(const HeapSurface& surface, const Vec2& axis, bool axisymmetric, double cell);

/// The value below which `share` of the values lie.
double percentile(std::vector<double> values, double share);

}  // namespace navvy::lab
