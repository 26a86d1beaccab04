// SPDX-License-Identifier: Apache-2.0
// Reads programs that are ordered while a scene runs.
#pragma once

#include <functional>
#include <string>

#include "scene/ground.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "scene/step_kind.h"

namespace navvy::scene_io {

/// Function that reads the elements of a program's steps for a machine on a ground.
using ProgramReader = std::function<scene::Program(const std::string& steps, const scene::Machine&,
                                                   const scene::StartGround&)>;

/// Returns a function that reads steps of the types `kinds`, as a scene has them inside
/// <navvy:program>, with all checks of a scene file. Messages name the file "order". It throws an
/// InputError with all errors and logs warnings.
ProgramReader ordered_program_reader(const scene::StepKinds& kinds);

}  // namespace navvy::scene_io
