// SPDX-License-Identifier: Apache-2.0
// Plane-strain rigs: a bed of soil between two smooth plates that are one shell with the tool, so
// that nothing leaks past the tool's ends and what the shell feels along x and z is the tool's
// force alone.
#pragma once

#include <vector>

#include "lab/tool_driver.h"
#include "scene/machine.h"

namespace navvy::lab {

/// The chute's frame: origin at the tool's lip (or the footing's middle), x ahead, z up, width
/// along y from 0 to `gap`.
struct ChuteShape {
  double gap = 0;         ///< between the side plates' faces: the width of the soil [m]
  double back = 0;        ///< side plates reach from x = -back ...
  double ahead = 0;       ///< ... to x = ahead [m]
  double bottom = 0;      ///< z of their lower edge, negative [m]
  double top = 0;         ///< z of their upper edge [m]
  double height = 0;      ///< of the blade's upper edge over the lip [m]
  double rake = kPi / 2;  ///< of the blade [rad]
  /// Half thickness of all plates; the faces, not the middles, stand at the given places [m].
  double half = 0;
};
/// Blade across a chute: side plates joined to the blade's ends. Inside and ahead of the blade is
/// the front.
scene::Shell blade_chute(const ChuteShape& shape);
/// The same as two shells, for blades with tool friction: the plates, smooth whatever the soil,
/// upright and as high all along; and the blade, which reaches to their middles.
scene::Shell chute_sides(const ChuteShape& shape);
scene::Shell chute_blade(const ChuteShape& shape);
/// Footing across a chute: a plate of `breadth` at z = 0 with upright sides up to the top, side
/// plates around.
scene::Shell footing_chute(const ChuteShape& shape, double breadth);

/// The soil of a plane-strain bed. W: z = 0 is the surface, the tool's lip starts at x = 0.
struct ChuteBed {
  double back = 0;   ///< behind the lip [m]
  double ahead = 0;  ///< in front of it [m]
  double below = 0;  ///< under z = 0, whole cells [m]
};
/// Where in y the chute stands: a little off the grid's planes, as any plate does [m].
double chute_offset(double cell);
/// Width of the chute [m]. Smooth tools: 5 cells. With tool friction the middle four blocks carry
/// it and a block of the same soil without tool friction lies against either side plate; `share` is
/// the middle's part of the width.
double chute_gap(const Setup& setup, double& share);
/// Soils for the site: 0 as it is, 1 the same without tool friction and adhesion.
std::vector<scene::Soil> chute_soils(const scene::Soil& soil);
/// Width of a chute whose plates are a smooth shell of their own [m]. tuned: a rough blade's force
/// is the same at 5, 8 and 16 cells within 2 % at 0.3 m/s; in slow motion 4 cells are too few.
double chute_width(double cell);
/// Half thickness of a chute's plates: a quarter of a cell, half the spacing of particles.
double chute_half(double cell);
/// Options of a site whose pit holds the bed: wider than the chute by two cells on either side.
SiteOptions chute_site(const Setup& setup, const ChuteBed& bed, double gap);
/// Bed of bank soil in the chute where `keep` allows, at rest under `surface(x, y)`.
std::vector<soil::Particle> chute_fill(const Site& site, const ChuteBed& bed, double gap,
                                       bool rough, const std::function<bool(const Vec3&)>& keep,
                                       const std::function<double(double, double)>& surface);

}  // namespace navvy::lab
