// SPDX-License-Identifier: Apache-2.0
// Contact of two machines of a world.
#pragma once

namespace navvy::sim {

/// Contact of links of two machines in the last step. Machines are indices of the scene, with
/// `machine` below `other_machine`; links are indices in scene::Machine::links.
struct MachineContact {
  int machine = 0, link = 0;              ///< first body
  int other_machine = 0, other_link = 0;  ///< second body
  double force = 0;                       ///< normal force, the mean over the step [N]
  double depth = 0;                       ///< depth of one body in the other [m]
  double size = 0;                        ///< smallest side of the box around the smaller body [m]
};

}  // namespace navvy::sim
