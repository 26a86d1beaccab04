// SPDX-License-Identifier: Apache-2.0
// Position of a solver's grid in W.
#pragma once

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// The grid frame G (particle.h) of one site.
///
/// Axes are those of W, lengths are in cells, and the height is counted from the ground's datum.
/// All particles, blocks and nodes of a solver count in it.
struct GridFrame {
  GridFrame(const scene::Scene& world, const heightfield::Ground& ground)
      : cell(ground.cell()),
        grid(plan_grid(world, ground)),
        origin(ground.origin().x() + grid.x * cell, ground.origin().y() + grid.y * cell,
               ground.datum()) {}

  /// Returns the position of a particle at the last transfer in W [m].
  Vec3 position(const Particle& p) const {
    Vec3 out;
    for (int a = 0; a < 3; ++a)
      out[a] = static_cast<double>(kBlockCells) * p.block[a] + static_cast<double>(p.x[a]);
    return origin + cell * out;
  }

  /// Edge of a cell [m].
  double cell;
  /// Position of blocks among the columns.
  PlanGrid grid;
  /// Origin of G in W [m].
  Vec3 origin;
};

}  // namespace navvy::soil
