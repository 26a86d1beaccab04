// SPDX-License-Identifier: Apache-2.0
// Shape of a pile of particles: surface, volume, front and slope. Uses positions only, none of the
// solver's own density states.
#pragma once

#include <utility>
#include <vector>

#include "lab/lab_site.h"

namespace navvy::lab {

/// Returns positions of the particles in contact with others: at least `neighbours` more in the 3 x
/// 3 x 3 cells around. The rest are single particles in flight or spread out.
std::vector<Vec3> in_contact(const Site& site, const std::vector<soil::Particle>& particles,
                             int neighbours = 8);

/// Heights over a rectangle, a quarter of a cell apart.
struct HeapSurface {
  /// Centre of the first column in W [m].
  Vec2 origin = Vec2::Zero();
  /// [m].
  double spacing = 0;
  /// Number of columns along x and y.
  int nx = 0, ny = 0;
  /// x fastest; `floor` where there is no soil [m].
  std::vector<double> top;
  /// Height of the floor [m].
  double floor = 0;

  /// Returns the height of a column [m].
  double at(int ix, int iy) const { return top[static_cast<std::size_t>(ix + nx * iy)]; }
  /// Returns the centre of a column in W [m].
  Vec2 middle(int ix, int iy) const { return origin + spacing * Vec2(ix, iy); }
  /// Returns the height over a particle of the pile, at the nearest column [m].
  double over(const Vec3& p) const;
  /// Returns the volume between surface and floor [m3].
  double volume() const;
  /// Returns the greatest height [m].
  double highest() const;
};

/// Returns the surface on which a ball rolls over the pile (closing with balls of 0.75 and 0.5
/// cells). It lies a quarter of a cell above the topmost particles, half the spacing of eight per
/// cell.
HeapSurface surface_of(const std::vector<Vec3>& positions, double cell, double floor);

/// Least-squares line z = a + b x.
struct Line {
  /// Intercept and slope.
  double a = 0, b = 0;
};
/// Returns the least-squares line through the points (x, z).
Line fit_line(const std::vector<double>& x, const std::vector<double>& z);

/// Returns distance from `axis` [m] and mean height over the floor [m], in rings (`axisymmetric`)
/// or in strips along x of half a cell over the middle third of the width.
std::vector<std::pair<double, double>> flank_profile(const HeapSurface& surface, const Vec2& axis,
                                                     bool axisymmetric, double cell);

/// Returns the angle of the flank of a heap [rad]: a least-squares line through its profile between
/// 20 and 80 % of its height.
double flank_angle(const HeapSurface& surface, const Vec2& axis, bool axisymmetric, double cell);

/// Returns the value below which the share `share` of the values lies.
double percentile(std::vector<double> values, double share);

}  // namespace navvy::lab
