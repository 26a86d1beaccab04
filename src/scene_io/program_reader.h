// SPDX-License-Identifier: Apache-2.0
// Reads the programs of machines.
#pragma once

#include "scene/program.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:program>; the name of each child selects the type of the step. The types check that
/// the machine can execute the step and that targets are on the site. `machine` and `ground` are
/// null if they could not be read; the checks that need them are then skipped.
scene::Program read_program(Element& element, const scene::StepKinds& kinds,
                            const scene::Machine* machine, const scene::StartGround* ground,
                            Faults& faults);

}  // namespace navvy::scene_io
