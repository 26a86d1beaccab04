// SPDX-License-Identifier: Apache-2.0
// Plane-strain rigs: a bed of soil between two smooth plates that form one shell with the tool.
// Nothing leaks past the tool's ends, and the force on the shell along x and z is that of the tool
// alone.
#pragma once

#include <vector>

#include "lab/tool_driver.h"
#include "scene/machine.h"

namespace navvy::lab {

/// Geometry of a chute. Its frame: origin at the tool's edge (or the footing's centre), x ahead, z
/// up, width along y from 0 to `gap`.
struct ChuteShape {
  /// Distance of the side plates' faces: the width of the soil [m].
  double gap = 0;
  /// Side plates reach from x = -back ...
  double back = 0;
  /// ... to x = ahead [m].
  double ahead = 0;
  /// z of their lower edge, negative [m].
  double bottom = 0;
  /// z of their upper edge [m].
  double top = 0;
  /// Height of the blade's upper edge over its cutting edge [m].
  double height = 0;
  /// Rake of the blade [rad].
  double rake = kPi / 2;
  /// Half thickness of all plates; positions refer to faces, not to mid-planes [m].
  double half = 0;
};
/// Returns a blade across a chute: side plates joined to the blade's ends. Inside and ahead of the
/// blade is the front.
scene::Shell blade_chute(const ChuteShape& shape);
/// Return the same as two shells, for blades with tool friction: the plates, smooth for any soil,
/// upright and of constant height; and the blade, which reaches to their mid-planes.
scene::Shell chute_sides(const ChuteShape& shape);
scene::Shell chute_blade(const ChuteShape& shape);
/// Returns a footing across a chute: a plate of `breadth` at z = 0 with upright sides up to the
/// top, and side plates around it.
scene::Shell footing_chute(const ChuteShape& shape, double breadth);

/// Soil of a plane-strain bed. W: z = 0 is the surface, the tool's edge starts at x = 0.
struct ChuteBed {
  /// Behind the edge [m].
  double back = 0;
  /// Ahead of it [m].
  double ahead = 0;
  /// Below z = 0, whole cells [m].
  double below = 0;
};
/// Returns the y of the chute: a little off the grid's planes, as any plate is [m].
double chute_offset(double cell);
/// Returns the width of the chute [m]: 5 cells for smooth tools. With tool friction, the middle
/// four blocks carry the tool and a block of the same soil without tool friction lies against
/// either side plate; `share` is the middle's share of the width.
double chute_gap(const Setup& setup, double& share);
/// Returns the soils of the site: 0 as it is, 1 the same without tool friction and adhesion.
std::vector<scene::Soil> chute_soils(const scene::Soil& soil);
/// Returns the width of a chute whose plates are a smooth shell of their own [m]. Tuned: a rough
/// blade's force is the same at 5, 8 and 16 cells within 2 % at 0.3 m/s; in slow motion 4 cells are
/// too few.
double chute_width(double cell);
/// Returns the half thickness of a chute's plates: a quarter of a cell, half the spacing of
/// particles [m].
double chute_half(double cell);
/// Returns options of a site whose pit holds the bed: wider than the chute by two cells on either
/// side.
SiteOptions chute_site(const Setup& setup, const ChuteBed& bed, double gap);
/// Returns a bed of bank soil in the chute where `keep` allows, at rest under `surface(x, y)`.
std::vector<soil::Particle> chute_fill(const Site& site, const ChuteBed& bed, double gap,
                                       bool rough, const std::function<bool(const Vec3&)>& keep,
                                       const std::function<double(double, double)>& surface);

}  // namespace navvy::lab
