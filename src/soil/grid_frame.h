// SPDX-License-Identifier: Apache-2.0
// Where the grid of a solver lies in W.
#pragma once

#include "core/math.h"
#include "heightfield/ground.h"
#include "scene/scene.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// The grid frame G (particle.h) of one site.
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

  double cell;    ///< edge of a cell [m]
  PlanGrid grid;  ///< where blocks begin among the columns
  Vec3 origin;    ///< W of the origin of G [m]
};

}  // namespace navvy::soil
