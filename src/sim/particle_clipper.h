// SPDX-License-Identifier: Apache-2.0
// Keeps drawn soil off the plates of the machines' tools, so that no lump shows through steel.
#pragma once

#include <vector>

#include "scene/frame.h"
#include "sim/world.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::sim {

/// Shells of a world's machines, prepared once.
class ParticleClipper {
 public:
  /// Prepares the shells of all machines. The world must outlive this object.
  explicit ParticleClipper(const World& world);

  /// Moves every drawn particle that is closer than `gap` [m] to a plate's face away from it, on
  /// its own side, as far as other plates allow. Then writes each particle's distance to the
  /// closest plate's face [m], at most `reach`.
  ///
  /// A particle is a point, and one that touches steel is on its face: its lump would be drawn half
  /// inside the plate. Costs a box test per particle and shell, and a search among the shell's
  /// triangles for those near it.
  void keep_off(scene::FrameParticles& particles, double gap, double reach) const;

 private:
  /// Shell of one machine, ready for distance queries.
  struct Tool {
    int machine, link;
    soil::ShellGeometry geometry;
  };

  const World& world_;
  std::vector<Tool> tools_;
};

}  // namespace navvy::sim
