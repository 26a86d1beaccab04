// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/ground.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:program>, every child by the kind that bears its name; no kind of step is known
/// here. Kinds check that the machine can do the step and that targets lie on the site: machine and
/// ground may be null where they could not be read.
scene::Program read_program(Element& element, const scene::StepKinds& kinds,
                            const scene::Machine* machine, const scene::StartGround* ground,
                            Faults& faults);

}  // namespace navvy::scene_io
