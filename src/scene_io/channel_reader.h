// SPDX-License-Identifier: Apache-2.0
// What a machine's controller sees and holds beside its joints: encoders and levers.
#pragma once

#include "scene/machine.h"
#include "scene_io/machine_names.h"

namespace navvy::scene_io {

/// Reads a <navvy:encoder> of a machine whose joints are known; adds it unless its joint has one
/// already.
void read_encoder(Element& element, const Names& names, scene::Machine& machine, Faults& faults);

/// Reads <navvy:levers>; the machine's arm is known.
void read_levers(Element& element, scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
