// SPDX-License-Identifier: Apache-2.0
// Rules for the navvy: elements of a machine beyond the ranges of single fields.
#pragma once

#include "scene/machine.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Checks the navvy: elements of a model after they were read, with its links and joints. Without
/// links, after faults in the SDF part, rules about them are skipped.
void check_extensions(Element& model, const Names& names, const scene::Machine& machine,
                      Faults& faults);

/// Sets the positions of joints at the start, from the <navvy:joint> children of `parent`.
void set_initial_positions(Element& parent, const std::vector<scene::InitialPosition>& positions,
                           scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
