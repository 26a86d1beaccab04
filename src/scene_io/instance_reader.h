// SPDX-License-Identifier: Apache-2.0
// Machines in a world: an <include> of a machine file, or a <model> of the scene.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Result of reading one machine file.
struct MachineFile {
  scene::Machine machine;  ///< the machine that the file describes; without links after an error
  /// Number of XML elements in the file; counts towards the limit of a scene.
  std::size_t elements = 0;
};

/// Information from earlier steps of reading that is needed to read a machine.
struct Known {
  const scene::StepKinds& kinds;  ///< all types of program steps
  bool ground = false;            ///< true: the ground was read without errors
  bool sdf_sound = false;         ///< true: the SDF part of the scene file has no errors
  /// Machines by path of their file, so that a file included several times is read and reported
  /// once.
  std::map<std::string, MachineFile>& files;
};

/// Reads an <include> or <model> of a world with its pose, joint positions, load and program. The
/// soils and the ground of `world` must have been read.
scene::MachineInWorld read_instance(Element& element, const scene::Scene& world, const Known& known,
                                    Faults& faults);

}  // namespace navvy::scene_io
