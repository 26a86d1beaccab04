// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"
#include "scene_io/loader.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the <world> of a document, after the overrides were applied to it. `kinds`: the program
/// steps that are known. The world that is answered after a fault is as far as it could be read;
/// the caller throws before anybody uses it.
scene::Scene read_world(Document& document, const scene::StepKinds& kinds, Faults& faults);

/// Reads the <model> of a machine file; an empty machine after a fault. What belongs to a world,
/// such as a program, is a fault in it.
scene::Machine read_machine_file(const std::string& file, Faults& faults);

}  // namespace navvy::scene_io
