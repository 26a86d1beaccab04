// SPDX-License-Identifier: Apache-2.0
// Shells that rigs use as tools. The front of a triangle is the side from which its corners are
// seen in counter-clockwise order.
#pragma once

#include "scene/machine.h"

namespace navvy::lab {

/// Returns a box that is open at the top, a vessel: `length` along x, `width` along y, `height`
/// along z [m]. The centre of its floor is the origin; the front of all triangles faces the inside.
scene::Shell open_box(double length, double width, double height);
/// Returns a closed box, a solid body: `length` along x, `width` along y, `height` along z [m]. The
/// centre of its floor is the origin; the front of all triangles faces the outside.
scene::Shell closed_box(double length, double width, double height);
/// Returns a flat blade: `width` along y, centred, and from z = 0 up to z = `height` [m]. Its front
/// faces +x. `rake` is the angle between its face and the ground ahead [rad]: pi/2 is upright, and
/// a smaller angle tilts the upper edge back towards -x.
scene::Shell blade(double width, double height, double rake = 1.5707963267948966);
/// Returns a flat horizontal plate: `length` along x, `width` along y [m], centred at the origin.
/// Its front faces +z.
scene::Shell plate(double length, double width);
/// Returns two parallel upright plates at y = 0 and y = `gap`, each from x = 0 to `length` and from
/// z = `bottom` to `top` [m]. If `back` is true, a third plate at x = 0 joins them. The front of
/// all plates faces the inside.
///
/// The plates are the smooth side walls of a plane-strain test, so the soil should have no tool
/// friction.
scene::Shell channel(double length, double gap, double bottom, double top, bool back);
/// Returns an upright tube of the given radius [m] about the z axis, from z = `bottom` to z = `top`
/// [m] and open at both ends. It consists of `sides` flat facets, whose front faces the inside.
scene::Shell tube(double radius, double bottom, double top, int sides = 32);
/// Returns a wheel: a closed drum of the given radius and width [m] about the y axis, whose tread
/// consists of `sides` flat facets. The front of all triangles faces the outside.
scene::Shell drum(double radius, double width, int sides = 48);

}  // namespace navvy::lab
