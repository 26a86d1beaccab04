// SPDX-License-Identifier: Apache-2.0
// Rules for links and joints. They are checked before libsdformat reads the model, as libsdformat
// reports no line numbers.
#pragma once

#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Checks parent, child, axes and limits of every joint of a model. `names` holds the names of the
/// model's links and frames, to which joints refer.
void check_joints(const Element& model, const Names& names, Faults& faults);

/// Checks masses, inertias and shapes of every link of a model. `needs_mass` is true if the links
/// move according to forces, and therefore need masses.
void check_links(const Element& model, bool needs_mass, Faults& faults);

}  // namespace navvy::scene_io
