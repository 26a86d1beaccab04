// SPDX-License-Identifier: Apache-2.0
// Where the soil of a world lies, for tests of what machines carry.
#pragma once

#include <vector>

#include "sim/session.h"

namespace navvy::sim::testing {

/// Soil that came to the rectangle [low, high] of W since the start [kg]: gain of its columns and the particles over
/// them.
inline double mass_gained(const World& world, const Vec2& low, const Vec2& high) {
  const heightfield::Ground& ground = world.ground();
  const Vec2i from = ground.column_at(low.x(), low.y()), to = ground.column_at(high.x(), high.y());
  std::int64_t sum = 0;
  std::vector<heightfield::Layer> now, start;
  for (int iy = from.y(); iy < to.y(); ++iy)
    for (int ix = from.x(); ix < to.x(); ++ix) {
      if (!ground.contains(ix, iy)) continue;
      ground.column(ix, iy, now);
      ground.start_column(ix, iy, start);
      for (const heightfield::Layer& layer : now) sum += layer.mass;
      for (const heightfield::Layer& layer : start) sum -= layer.mass;
    }
  for (const soil::Particle& p : world.soil().particles()) {
    const Vec2 at(p.block[0] * soil::kBlockCells + static_cast<double>(p.x[0]),
                  p.block[1] * soil::kBlockCells + static_cast<double>(p.x[1]));
    const bool inside = at.x() >= from.x() && at.y() >= from.y() && at.x() < to.x() && at.y() < to.y();
    if (inside) sum += p.mass;
  }
  return kilograms(sum);
}

/// Soil in the shell `name` of machine `m` [kg].
inline double carried(const World& world, int m, const std::string& name) {
  const scene::Machine& machine = world.description().machines[static_cast<std::size_t>(m)].machine;
  for (const coupling::ToolLoad& tool : world.coupling().tools())
    if (tool.machine == m && machine.shells[static_cast<std::size_t>(tool.shell)].name == name)
      return world.coupling().payload(tool);
  return -1;
}

}  // namespace navvy::sim::testing
