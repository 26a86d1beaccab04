// SPDX-License-Identifier: Apache-2.0
// Boxes around collision shapes, for callers that need only a box.
#pragma once

#include <optional>

#include "geometry/oriented_box.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Returns the box around a collision shape, in the frame of the link that carries the shape.
/// Returns nothing for a plane, which callers treat as ground, and for a mesh file that cannot be
/// read, which the scene loader has already reported.
std::optional<geometry::OrientedBox> box_of(const scene::Collision& collision);

}  // namespace navvy::vehicle
