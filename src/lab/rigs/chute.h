// SPDX-License-Identifier: Apache-2.0
// Plane-strain rigs: a bed of soil between two smooth side plates that are joined to the tool and
// form one shell with it. No soil leaks past the tool's ends, and the force on the shell along x
// and z is the force on the tool, because smooth plates take no such force.
#pragma once

#include <vector>

#include "lab/tool_driver.h"
#include "scene/machine.h"

namespace navvy::lab {

/// Geometry of a chute: two side plates and the tool between them. The origin of the chute's frame
/// is at the tool's cutting edge, or at the centre of a footing. x points ahead, z up, and the soil
/// between the plates extends from y = 0 to y = `gap`.
struct ChuteShape {
  /// Distance between the inner faces of the side plates, the width of the soil [m].
  double gap = 0;
  /// Distance by which the side plates extend behind the origin, to x = -back [m]. A footing
  /// ignores it: its plates extend by `ahead` on both sides.
  double back = 0;
  /// Distance by which the side plates extend ahead of the origin, to x = ahead [m].
  double ahead = 0;
  /// z of the side plates' lower edge [m]; negative.
  double bottom = 0;
  /// z of the side plates' upper edge [m].
  double top = 0;
  /// Height of the blade's upper edge above its cutting edge [m].
  double height = 0;
  /// Angle between the blade's face and the ground ahead [rad]; pi/2 is upright.
  double rake = kPi / 2;
  /// Half the thickness of all plates [m]. The lengths above refer to plate faces, not to their
  /// mid-planes.
  double half = 0;
};
/// Returns a blade across a chute as one shell: the side plates are joined to the ends of the
/// blade. The front of the triangles faces the soil between the plates and ahead of the blade.
scene::Shell blade_chute(const ChuteShape& shape);
/// Returns only the side plates of a chute, upright and of constant height, without friction or
/// adhesion for any soil. Used with chute_blade where the blade has tool friction.
scene::Shell chute_sides(const ChuteShape& shape);
/// Returns only the blade of a chute, with the soil's tool friction. It extends to the mid-planes
/// of the side plates (chute_sides), so that no soil passes its ends.
scene::Shell chute_blade(const ChuteShape& shape);
/// Returns a footing across a chute as one shell: a horizontal plate of `breadth` [m] along x at z
/// = 0 with upright sides up to `top`, and side plates at both ends.
scene::Shell footing_chute(const ChuteShape& shape, double breadth);

/// Extent of the soil bed of a plane-strain rig, in W. The surface of the soil is z = 0, and the
/// tool's cutting edge starts at x = 0.
struct ChuteBed {
  /// Length of the bed behind x = 0 [m].
  double back = 0;
  /// Length of the bed ahead of x = 0 [m].
  double ahead = 0;
  /// Depth of the bed below z = 0, a whole number of cells [m].
  double below = 0;
};
/// Returns the y coordinate of the chute's origin in W [m] for the cell size `cell` [m]. It is
/// slightly off y = 0, so that no plate coincides with a plane of grid nodes.
double chute_offset(double cell);
/// Returns the width of a chute whose blade and side plates are one shell [m]. Without tool
/// friction it is 5 cells, and `share` is set to 0. With tool friction, the soil with friction
/// occupies the middle four blocks, and one block of the same soil without tool friction lies at
/// each side plate; `share` is set to the middle's share of the width.
double chute_gap(const Setup& setup, double& share);
/// Returns two soils for a site: index 0 is `soil` itself, index 1 is the same soil without tool
/// friction and adhesion.
std::vector<scene::Soil> chute_soils(const scene::Soil& soil);
/// Returns the width [m] of a chute whose side plates are a separate smooth shell: 8 cells. At 0.3
/// m/s, the force on a rough blade per width is the same with 5, 8 and 16 cells within 2 %; in slow
/// motion 4 cells are too few.
double chute_width(double cell);
/// Returns half the thickness of a chute's plates [m]: a quarter of the cell size `cell` [m], which
/// is half the particle spacing.
double chute_half(double cell);
/// Returns the options of a site with a pit for the bed. The pit is as long and deep as `bed` and
/// two cells wider than the chute's width `gap` [m] on each side.
SiteOptions chute_site(const Setup& setup, const ChuteBed& bed, double gap);
/// Returns new particles of bank soil that fill the chute where `keep(position)` is true, with the
/// stress of ground at rest under the height `surface(x, y)` [m]. If `rough` is true, the soil near
/// the side plates is the one without tool friction (index 1 of chute_soils) and the rest has index
/// 0; otherwise all of it has index 1. The particles are not inserted into the solver.
std::vector<soil::Particle> chute_fill(const Site& site, const ChuteBed& bed, double gap,
                                       bool rough, const std::function<bool(const Vec3&)>& keep,
                                       const std::function<double(double, double)>& surface);

}  // namespace navvy::lab
