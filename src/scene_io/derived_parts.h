// SPDX-License-Identifier: Apache-2.0
// Collision shapes and masses that follow from the rest of a machine's file.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Gives the links of a dynamic or static machine without any <collision> the shapes of their
/// visuals, except planes, unless `navvy:derive_collisions` is false. Links that carry a shell or
/// spin a wheel are left out. Then gives every link with a density and without <inertial> the mass,
/// centre and inertia of its collision shapes, or of its visuals where it has none; each is solid
/// and counted whole.
///
/// Adds a sentence per link to `machine.derived`. Links, wheels and shells must have been read.
void derive_parts(const Element& model, scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
