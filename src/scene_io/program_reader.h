// SPDX-License-Identifier: Apache-2.0
// Programs of machines.
#pragma once

#include "scene/program.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads a <navvy:program>. Each child element is read by the step type with its name. The step
/// types check that the machine can perform the step and that targets are on the site. `machine`
/// and `ground` may be null if they could not be read; such checks are then skipped.
scene::Program read_program(Element& element, const scene::StepKinds& kinds,
                            const scene::Machine* machine, const scene::StartGround* ground,
                            Faults& faults);

}  // namespace navvy::scene_io
