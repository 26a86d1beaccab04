// SPDX-License-Identifier: Apache-2.0
// Boxes around collision shapes, for callers that need only a box.
#pragma once

#include <cstddef>
#include <optional>

#include "geometry/oriented_box.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Returns the box around a collision shape, in the frame of the link that carries the shape.
/// Returns nothing for a plane, which callers treat as ground, and for a mesh file that cannot be
/// read, which the scene loader has already reported.
std::optional<geometry::OrientedBox> box_of(const scene::Collision& collision);

/// Box around a wheel, with its twin if it has one.
struct WheelBox {
  std::size_t link = 0;       ///< index of the link that carries the wheel
  geometry::OrientedBox box;  ///< box in the frame of that link; the axle is its y axis
};

/// Returns the box around a wheel of `machine`; nothing if the machine lacks the wheel's joint.
std::optional<WheelBox> box_of(const scene::Machine& machine, const scene::Wheel& wheel);

}  // namespace navvy::vehicle
