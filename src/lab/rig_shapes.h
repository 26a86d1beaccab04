// SPDX-License-Identifier: Apache-2.0
// Shells that rigs are made of. The front is the side a triangle's normal (counter-clockwise)
// points to.
#pragma once

#include "scene/machine.h"

namespace navvy::lab {

/// A box open at the top: floor at z = 0, middle at the origin, inside = front [m].
scene::Shell open_box(double length, double width, double height);
/// The same with a lid and its front outside: a body.
scene::Shell closed_box(double length, double width, double height);
/// An upright plate of `width` along y from z = 0 up to `height`; its front looks along +x. `rake`
/// [rad] leans the top back along -x: rake 90 degrees is upright, less is flatter (the angle of the
/// face with the ground ahead).
scene::Shell blade(double width, double height, double rake = 1.5707963267948966);
/// A flat plate, middle at the origin, `length` along x, `width` along y; its front looks along +z.
scene::Shell plate(double length, double width);
/// Two upright plates y = 0 and y = `gap` from x = 0 to `length`, z = `bottom` to `top`, closed at
/// x = 0 when `back`; inside = front. Smooth walls of a plane-strain test: use a soil without tool
/// friction.
scene::Shell channel(double length, double gap, double bottom, double top, bool back);
/// An upright tube of `radius` about the z axis, z = `bottom` to `top`, of `sides` flat facets;
/// inside = front.
scene::Shell tube(double radius, double bottom, double top, int sides = 32);
/// A wheel: a closed drum of `radius` and `width` about the y axis, of `sides` flat facets; front
/// outside.
scene::Shell drum(double radius, double width, int sides = 48);

}  // namespace navvy::lab
