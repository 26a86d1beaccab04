// SPDX-License-Identifier: Apache-2.0
// Moves drawn soil particles away from the plates of the machines' tools, so that no drawn lump of
// soil is visible through steel.
#pragma once

#include <vector>

#include "scene/frame.h"
#include "sim/world.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::sim {

/// Moves drawn particles of a world away from the steel plates (shells) of its machines. The
/// constructor prepares the shells once for many frames.
class ParticleClipper {
 public:
  /// Prepares the shells of all machines. The world must outlive this object.
  explicit ParticleClipper(const World& world);

  /// Moves every drawn particle that is closer than `gap` [m] to the face of a plate away from that
  /// face. The particle stays on its side of the plate; where other plates leave less space, it is
  /// moved as far as they allow. Then sets `particles.clearance`, one entry per particle: the
  /// distance to the face of the closest plate [m], at most `reach` [m], and `particles.away`: the
  /// direction from there.
  ///
  /// A particle is a point, and a particle that touches steel lies on its face, so half of its
  /// drawn lump would be inside the plate. Costs a box test per particle and shell, and for
  /// particles near a shell a search among nearby triangles.
  void keep_off(scene::FrameParticles& particles, double gap, double reach) const;

 private:
  /// Shell of one machine, prepared for distance queries.
  struct Tool {
    /// Index of the machine in the scene, and of the shell's link in that machine.
    int machine, link;
    /// Triangles of the shell in the frame of its link.
    soil::ShellGeometry geometry;
  };

  const World& world_;
  /// Shells of all machines, machine by machine.
  std::vector<Tool> tools_;
};

}  // namespace navvy::sim
