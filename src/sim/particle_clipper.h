// SPDX-License-Identifier: Apache-2.0
// Keeps drawn soil off the plates of the machines' tools, so that no lump sticks out through steel.
#pragma once

#include <vector>

#include "scene/frame.h"
#include "sim/world.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::sim {

/// The shells of a world's machines, prepared once.
class ParticleClipper {
 public:
  explicit ParticleClipper(const World& world);

  /// Moves every drawn particle that is nearer than `gap` [m] to a plate's face off it, on the side
  /// that it is on, as far as the plates leave it room there. Then fills `room`: the distance to
  /// the closest plate's face [m], from 0 to `reach`; `reach` for all that is farther.
  ///
  /// A particle is a point, and one that lies on steel lies on its very face: its lump would be
  /// drawn half within the plate. Costs a box test a particle and shell, and a search among the
  /// shell's triangles for those near it.
  void keep_off(scene::FrameParticles& particles, double gap, double reach) const;

 private:
  struct Tool {
    int machine, link;
    soil::ShellGeometry geometry;
  };

  const World& world_;
  std::vector<Tool> tools_;
};

}  // namespace navvy::sim
