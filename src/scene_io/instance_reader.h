// SPDX-License-Identifier: Apache-2.0
// Machines in a world: an <include> of a machine file, or a <model> of the scene.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// A machine file that was read, and the number of its XML elements.
struct MachineFile {
  scene::Machine machine;
  std::size_t elements = 0;
};

/// Results of earlier reading steps that machines in a world depend on.
struct Known {
  const scene::StepKinds& kinds;
  /// True if the ground was read without errors.
  bool ground = false;
  /// True if the standard SDF elements of the scene file have no errors.
  bool sdf_sound = false;
  /// Machine files by path. Each is read, and its errors are reported, only once.
  std::map<std::string, MachineFile>& files;
};

/// Reads an <include> or <model> of a world: machine, pose, initial joint positions, load and
/// program. The world's soils and ground must have been read.
scene::MachineInWorld read_instance(Element& element, const scene::Scene& world, const Known& known,
                                    Faults& faults);

}  // namespace navvy::scene_io
