// SPDX-License-Identifier: Apache-2.0
// Machines in a world: an <include> of a machine file, or a <model> of the scene.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"
#include "scene/step_kind.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// A machine file that has been read.
struct MachineFile {
  scene::Machine machine;
  std::size_t elements = 0;
};

/// Results of reading that machines depend on.
struct Known {
  const scene::StepKinds& kinds;
  bool ground = false;                        ///< the site was read without errors
  bool sdf_sound = false;                     ///< the SDF of the scene file has no errors
  std::map<std::string, MachineFile>& files;  ///< machines by file, each read and reported once
};

/// Reads an <include> or <model> with its place, joints, load and program. Soils and ground of the
/// world are known.
scene::MachineInWorld read_instance(Element& element, const scene::Scene& world, const Known& known,
                                    Faults& faults);

}  // namespace navvy::scene_io
