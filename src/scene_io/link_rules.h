// SPDX-License-Identifier: Apache-2.0
// Rules for links and joints, checked before libsdformat reads them, as it knows no lines.
#pragma once

#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Checks ends, axes and limits of every joint.
void check_joints(const Element& model, const Names& names, Faults& faults);

/// Checks masses, inertias and shapes of every link; `needs_mass` if the links move.
void check_links(const Element& model, bool needs_mass, Faults& faults);

}  // namespace navvy::scene_io
