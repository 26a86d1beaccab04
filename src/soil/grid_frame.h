// SPDX-License-Identifier: Apache-2.0
// Position of a solver's grid relative to the world frame W.
#pragma once

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// The grid frame G (particle.h) of one site.
///
/// The axes of G are those of W, lengths in G are in cells, and heights in G start at the ground's
/// datum. The positions of all particles, blocks and nodes of a solver are coordinates in G.
struct GridFrame {
  /// Derives the frame from the ground's origin, cell and datum, and from the start position of the
  /// world's first machine (plan_grid).
  GridFrame(const scene::Scene& world, const heightfield::Ground& ground)
      : cell(ground.cell()),
        grid(plan_grid(world, ground)),
        origin(ground.origin().x() + grid.x * cell, ground.origin().y() + grid.y * cell,
               ground.datum()) {}

  /// Returns the position of a particle in W at the last transfer [m]. It does not include
  /// Particle::moved.
  Vec3 position(const Particle& p) const {
    Vec3 out;
    for (int a = 0; a < 3; ++a)
      out[a] = static_cast<double>(kBlockCells) * p.block[a] + static_cast<double>(p.x[a]);
    return origin + cell * out;
  }

  /// Edge of a cell [m].
  double cell;
  /// Offset of the particle blocks relative to the site's columns.
  PlanGrid grid;
  /// Origin of G in W [m].
  Vec3 origin;
};

}  // namespace navvy::soil
