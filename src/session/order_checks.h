// SPDX-License-Identifier: Apache-2.0
// Checks of programs that are ordered while a session runs. Private to the session.
#pragma once

#include <string>

#include "control/planners.h"
#include "session/operated_machine.h"
#include "session/uncontrolled_machine.h"
#include "sim/world.h"

namespace navvy::session {

/// Returns the index of the machine called `name`. @throws InputError with the nearest name.
int machine_of_order(const scene::Scene& scene, const std::string& name);
/// Checks that no program of the machine runs. @throws InputError that names the running step.
void require_idle(const OperatedMachine& machine);
/// Checks that the machine called `name` has neither tipped over nor been buried. @throws
/// InputError with the reason.
void require_upright(const std::string& name, const UncontrolledMachine& machine);
/// Reads a program from `steps` for the machine with the index `machine`, and checks it from where
/// the machine stands, on the ground `around` it. Logs warnings.
/// @throws InputError with all errors, also if `planners` cannot read programs.
scene::Program program_of_order(const sim::World& world, int machine, const std::string& steps,
                                const control::SurfaceView& around,
                                const control::Planners& planners);

}  // namespace navvy::session
