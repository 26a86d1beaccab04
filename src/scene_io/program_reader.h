// SPDX-License-Identifier: Apache-2.0
// Programs of machines.
#pragma once

#include "scene/program.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:program>, every child by the kind of its name. Kinds check that the machine can do
/// the step and that targets are on the site; machine and ground are null if they could not be
/// read.
scene::Program read_program(Element& element, const scene::StepKinds& kinds,
                            const scene::Machine* machine, const scene::StartGround* ground,
                            Faults& faults);

}  // namespace navvy::scene_io
