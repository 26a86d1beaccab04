// SPDX-License-Identifier: Apache-2.0
// What links and joints of a machine must hold before libsdformat sees them: it would find the
// faults without a line.
#pragma once

#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Ends, axes and limits of every joint.
void check_joints(const Element& model, const Names& names, Faults& faults);

/// Masses, inertias and shapes of every link; `needs_mass` where the links move.
void check_links(const Element& model, bool needs_mass, Faults& faults);

}  // namespace navvy::scene_io
