// SPDX-License-Identifier: Apache-2.0
// What follows from the rest of a machine's file when it is not given: collision shapes and masses.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Gives the links of a dynamic or static machine without a single <collision> the shapes of their
/// visuals (planes apart), unless `navvy:derive_collisions` is false. Links that carry a shell or
/// spin a wheel are left out: they touch by their steel and their tyre. Then gives every link with
/// `navvy:density_kg_per_m3` and without <inertial> the mass, centre and inertia of its collision
/// shapes, or of its visuals where it has none, solid and each counted whole.
///
/// What was derived stands in `machine.derived`, a sentence a link. Call it when links, wheels and
/// shells are read.
void derive_parts(const Element& model, scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
