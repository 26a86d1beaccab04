// SPDX-License-Identifier: Apache-2.0
// Shells of rigs. The front is the side that a triangle's normal (counter-clockwise) points to.
#pragma once

#include "scene/machine.h"

namespace navvy::lab {

/// Returns a box open at the top: floor at z = 0, centre at the origin, inside = front [m].
scene::Shell open_box(double length, double width, double height);
/// Returns a box with a lid whose outside is the front: a body [m].
scene::Shell closed_box(double length, double width, double height);
/// Returns an upright plate of `width` along y from z = 0 up to `height` [m]; its front faces +x.
/// `rake` [rad] tilts the top back along -x: 90 degrees is upright, less is flatter (angle of the
/// face with the ground ahead).
scene::Shell blade(double width, double height, double rake = 1.5707963267948966);
/// Returns a flat plate, centre at the origin, `length` along x, `width` along y [m]; its front
/// faces +z.
scene::Shell plate(double length, double width);
/// Returns two upright plates y = 0 and y = `gap` from x = 0 to `length`, z = `bottom` to `top`
/// [m], closed at x = 0 when `back`; inside = front. They are the smooth walls of a plane-strain
/// test: use a soil without tool friction.
scene::Shell channel(double length, double gap, double bottom, double top, bool back);
/// Returns an upright tube of `radius` about the z axis, z = `bottom` to `top` [m], of `sides` flat
/// facets; inside = front.
scene::Shell tube(double radius, double bottom, double top, int sides = 32);
/// Returns a wheel: a closed drum of `radius` and `width` [m] about the y axis, of `sides` flat
/// facets; outside = front.
scene::Shell drum(double radius, double width, int sides = 48);

}  // namespace navvy::lab
