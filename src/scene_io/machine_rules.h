// SPDX-License-Identifier: Apache-2.0
// Rules for the navvy: elements of a machine beyond the ranges of single fields.
#pragma once

#include "scene/machine.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Checks rules for the navvy: elements of a model that involve several fields. The fields, links
/// and joints must have been read. If SDF errors prevented the reading of links, rules about links
/// are skipped.
void check_extensions(Element& model, const Names& names, const scene::Machine& machine,
                      Faults& faults);

/// Sets the initial positions of the machine's joints. `positions` were read from the <navvy:joint>
/// children of `parent`, in the same order.
void set_initial_positions(Element& parent, const std::vector<scene::InitialPosition>& positions,
                           scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
