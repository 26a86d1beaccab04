// SPDX-License-Identifier: Apache-2.0
// Rules for the `navvy:` elements of a machine, beyond the ranges of single fields.
#pragma once

#include "scene/machine.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Checks the `navvy:` elements of a model after they have been read into `machine` together with
/// links and joints. If errors in the SDF part have left the machine without links, the rules that
/// need links are skipped.
void check_extensions(Element& model, const Names& names, const scene::Machine& machine,
                      Faults& faults);

/// Sets the positions of the machine's joints at the start. `positions` has been read from the
/// <navvy:joint> children of `parent`, at which errors are reported.
void set_initial_positions(Element& parent, const std::vector<scene::InitialPosition>& positions,
                           scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
