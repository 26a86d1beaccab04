// SPDX-License-Identifier: Apache-2.0
// How far drawn soil is from the plates of the machines' tools, so that no lump sticks out through steel.
#pragma once

#include <span>
#include <vector>

#include "sim/world.h"
#include "soil/particles/particle.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::sim {

/// The shells of a world's machines, prepared once.
class PlateRoom {
 public:
  explicit PlateRoom(const World& world);

  /// By particle: distance to the closest plate's face [m], at most `reach`, never below 0; `reach` for all that is
  /// farther. Costs a box test a particle and shell, and a search among the shell's triangles for those near it.
  std::vector<float> of(std::span<const soil::Particle> particles, double reach) const;

 private:
  struct Tool {
    int machine, link;
    soil::ShellGeometry geometry;
  };

  const World& world_;
  std::vector<Tool> tools_;
};

}  // namespace navvy::sim
