// SPDX-License-Identifier: Apache-2.0
// Sites to drive on, and the excavator.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "control/surface.h"
#include "heightfield/layered_ground.h"
#include "map/grounds.h"
#include "paths.h"
#include "scene_io/loader.h"

namespace navvy::planner::testing {

using map::testing::centre;
using map::testing::setup;

inline scene::Machine excavator() {
  return scene_io::load_machine(navvy::source_dir() + "/vehicles/ew180/model.sdf");
}

/// Returns a level site, 36 m x 24 m about the origin, with columns of 0.15 m.
inline heightfield::Ground level_site() {
  heightfield::GroundSetup s = setup(240, 160);
  s.cell = 0.15;
  s.origin = Vec2(-18, -12);
  return heightfield::Ground(s);
}

/// Removes half a metre from every column whose centre is in the rectangle.
inline void dig(heightfield::Ground& ground, const Vec2& low, const Vec2& high) {
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const Vec2 p = centre(ground.setup(), ix, iy);
      if ((p.array() > low.array()).all() && (p.array() < high.array()).all())
        ground.take_above(ix, iy, -0.5, taken);
    }
}

/// Fills these columns again to z = 0.
inline void fill(heightfield::Ground& ground, const Vec2& low, const Vec2& high) {
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const Vec2 p = centre(ground.setup(), ix, iy);
      if (!((p.array() > low.array()).all() && (p.array() < high.array()).all())) continue;
      const double lacks = -ground.height(ix, iy) * ground.cell() * ground.cell() * 1540;
      if (lacks > 0) ground.put(ix, iy, {0, mass_units(lacks), 1.0f, 0});
    }
}

}  // namespace navvy::planner::testing
