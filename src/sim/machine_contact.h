// SPDX-License-Identifier: Apache-2.0
// Contact of two machines of a world.
#pragma once

#include "core/archive.h"

namespace navvy::sim {

/// Links of two machines. Machines are indices in scene::Scene::machines, with `machine` below
/// `other_machine`; links are indices in scene::Machine::links.
struct LinkPair {
  int machine = 0, link = 0;              ///< first body
  int other_machine = 0, other_link = 0;  ///< second body

  /// Returns true if `other` has the same two links.
  bool is_of(const LinkPair& other) const {
    return machine == other.machine && link == other.link && other_machine == other.other_machine &&
           other_link == other.other_link;
  }
  /// Saves or loads the four indices.
  void visit_links(Archive& a);
};

/// Contact of links of two machines in the last step.
struct MachineContact : LinkPair {
  double force = 0;  ///< normal force, the mean over the step [N]
  double depth = 0;  ///< depth of one body in the other [m]
  double size = 0;   ///< smallest side of the box around the smaller body [m]
};

}  // namespace navvy::sim
