// SPDX-License-Identifier: Apache-2.0
// Shape of a heap of particles: surface, volume, front and slope. The functions use particle
// positions only, not the density states that the solver computes.
#pragma once

#include <utility>
#include <vector>

#include "lab/lab_site.h"

namespace navvy::lab {

/// Returns the positions [m] of those `particles` that touch others: at least `neighbours` other
/// particles lie in the block of 3 x 3 x 3 cells around them. The others are in flight or
/// scattered.
std::vector<Vec3> in_contact(const Site& site, const std::vector<soil::Particle>& particles,
                             int neighbours = 8);

/// Surface of a heap as heights on a regular grid of columns, a quarter of a cell apart.
struct HeapSurface {
  /// Centre of the column (0, 0) in W [m].
  Vec2 origin = Vec2::Zero();
  /// Distance between neighbouring columns along x and y [m].
  double spacing = 0;
  /// Number of columns along x and along y.
  int nx = 0, ny = 0;
  /// Height of each column in W [m], at the index ix + nx * iy. Where there is no soil, it is
  /// `floor`.
  std::vector<double> top;
  /// Height of the floor under the heap, in W [m].
  double floor = 0;

  /// Returns the height of the column (ix, iy), in W [m]. The indices are not checked.
  double at(int ix, int iy) const { return top[static_cast<std::size_t>(ix + nx * iy)]; }
  /// Returns the centre of the column (ix, iy), in W [m].
  Vec2 middle(int ix, int iy) const { return origin + spacing * Vec2(ix, iy); }
  /// Returns the height of the surface at the column nearest to `p` [m]. `p` must be a particle of
  /// the heap.
  double over(const Vec3& p) const;
  /// Returns the volume between the surface and the floor [m3].
  double volume() const;
  /// Returns the maximum height of the surface, in W [m]; `floor` if there is no soil.
  double highest() const;
};

/// Returns the surface of the heap of particles at `positions` [m] on a floor at the height `floor`
/// [m]; `cell` is the cell size [m]. The surface is a morphological closing with balls of 0.75 and
/// 0.5 cells, which fills gaps that the smaller ball cannot enter. It lies a quarter of a cell
/// above the topmost particles, half the particle spacing.
HeapSurface surface_of(const std::vector<Vec3>& positions, double cell, double floor);

/// Straight line z = a + b x.
struct Line {
  /// Intercept a and slope b.
  double a = 0, b = 0;
};
/// Returns the least-squares line through the points (x, z). Both lists must have the same length,
/// and at least two different x.
Line fit_line(const std::vector<double>& x, const std::vector<double>& z);

/// Returns the profile of a heap: pairs of the distance from `axis` [m] and the mean height above
/// the floor at that distance [m], half a cell apart. If `axisymmetric` is true, heights are
/// averaged over rings around `axis`. Otherwise they are averaged over strips at equal |x| on both
/// flanks, within the middle third of the heap's width along y. `cell` is the cell size [m].
std::vector<std::pair<double, double>> flank_profile(const HeapSurface& surface, const Vec2& axis,
                                                     bool axisymmetric, double cell);

/// Returns the slope angle of a heap's flank [rad]: that of the least-squares line through its
/// profile between 20 % and 80 % of the maximum height. `axis`, `axisymmetric` and `cell` are as in
/// flank_profile. Returns NaN if the flank has fewer than two points.
double flank_angle(const HeapSurface& surface, const Vec2& axis, bool axisymmetric, double cell);

/// Returns the value below which the fraction `share` (0 to 1) of `values` lies; NaN if `values` is
/// empty.
double percentile(std::vector<double> values, double share);

}  // namespace navvy::lab
