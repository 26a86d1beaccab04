// SPDX-License-Identifier: Apache-2.0
// Distribution of soil in a world, for tests of the load of machines.
#pragma once

#include <vector>

#include "session/session.h"

namespace navvy::session::testing {

/// Returns the soil gained by the rectangle [low, high] of W since the start [kg]: in its columns
/// and the particles above them.
inline double mass_gained(const sim::World& world, const Vec2& low, const Vec2& high) {
  const heightfield::Ground& ground = world.ground();
  const Vec2i from = ground.column_at(low.x(), low.y()), to = ground.column_at(high.x(), high.y());
  std::int64_t sum = 0;
  std::vector<heightfield::SoilLayer> now, start;
  for (int iy = from.y(); iy < to.y(); ++iy)
    for (int ix = from.x(); ix < to.x(); ++ix) {
      if (!ground.contains(ix, iy)) continue;
      ground.column(ix, iy, now);
      ground.start_column(ix, iy, start);
      for (const heightfield::SoilLayer& layer : now) sum += layer.mass;
      for (const heightfield::SoilLayer& layer : start) sum -= layer.mass;
    }
  for (const sim::ActiveParticle& loose : world.soil().loose_soil())
    if (loose.ix >= from.x() && loose.iy >= from.y() && loose.ix < to.x() && loose.iy < to.y())
      sum += loose.mass;
  return kilograms(sum);
}

/// Returns the soil in the shell `name` of machine `m` [kg].
inline double carried(const sim::World& world, int m, const std::string& name) {
  return world.machines().at(m).tool(name).payload();
}

}  // namespace navvy::session::testing
