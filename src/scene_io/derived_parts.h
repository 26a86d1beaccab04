// SPDX-License-Identifier: Apache-2.0
// Collision shapes and masses that are derived from other parts of a machine's file.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Completes a dynamic or static machine whose links, wheels and shells have been read.
/// First, if the machine has no <collision> at all and `navvy:derive_collisions` is not false, each
/// link gets the shapes of its visuals as collision shapes. Planes are excluded, and so are links
/// that carry a shell or are spun as a wheel. Then each link with a density and without <inertial>
/// gets the mass, centre of mass and inertia of its collision shapes, or of its visuals if it has
/// no collision shapes; each shape is taken as solid, and overlaps count twice.
///
/// A sentence about each link concerned is added to `machine.derived`.
void derive_parts(const Element& model, scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
