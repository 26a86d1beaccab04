// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/ground.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads <navvy:program>: checks that the machine can do each step and that targets lie on the site. Both may be null
/// where they could not be read; the checks that need them are left out then.
scene::Program read_program(Element& element, const scene::Machine* machine, const scene::Ground* ground,
                            Faults& faults);

}  // namespace navvy::scene_io
