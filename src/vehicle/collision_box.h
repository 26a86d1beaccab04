// SPDX-License-Identifier: Apache-2.0
// Collision shapes as boxes, where a box is sufficient.
#pragma once

#include <optional>

#include "geometry/oriented_box.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Returns the box around a collision shape in the frame of its link. Returns nothing for planes,
/// which are ground of their own, and for meshes that cannot be read, which the loader has
/// reported.
std::optional<geometry::OrientedBox> box_of(const scene::Collision& collision);

}  // namespace navvy::vehicle
