// SPDX-License-Identifier: Apache-2.0
#include "sim/plate_room.h"

#include <algorithm>
#include <cmath>

#include "geometry/pieces.h"
#include "sim/world_parts.h"

namespace navvy::sim {

PlateRoom::PlateRoom(const World& world) : world_(world) {
  for (std::size_t m = 0; m < world.description().machines.size(); ++m) {
    const scene::Machine& machine = world.description().machines[m].machine;
    for (const scene::Shell& shell : machine.shells)
      tools_.push_back({static_cast<int>(m), machine.link_index(shell.link), {shell, world.ground().cell()}});
  }
}

std::vector<float> PlateRoom::of(std::span<const soil::Particle> particles, double reach) const {
  const auto far = static_cast<float>(reach);
  std::vector<float> out(particles.size(), far);
  const double cell = world_.ground().cell();
  const Vec3 origin = parts(world_).soil.grid_origin();
  for (const Tool& tool : tools_) {
    const Pose X_WT = world_.machine(tool.machine).link(tool.link).pose(), X_TW = X_WT.inverse();
    // Most particles are far from any tool: a ball about the shell's box answers for them.
    const geometry::Box box = geometry::bounds(tool.geometry.shell());
    const Vec3 centre = X_WT * (0.5 * (box.low + box.high));
    const double radius = 0.5 * (box.high - box.low).norm() + reach;
    const double half = tool.geometry.shell().half_thickness;
    int closest = 0;  // triangle of the particle before: neighbours in memory are neighbours in space
    for (std::size_t i = 0; i < particles.size(); ++i) {
      Vec3 grid;
      for (int a = 0; a < 3; ++a)
        grid[a] = soil::kBlockCells * particles[i].block[a] + static_cast<double>(particles[i].x[a]);
      const Vec3 p_W = origin + cell * grid;
      if ((p_W - centre).squaredNorm() > radius * radius) continue;
      const Vec3 p_T = X_TW * p_W;
      // The box itself leaves out soil below an empty bucket's ball.
      if ((p_T.array() < box.low.array() - reach).any() || (p_T.array() > box.high.array() + reach).any()) continue;
      const double room = std::abs(tool.geometry.distance(p_T, closest)) - half;
      out[i] = std::min(out[i], static_cast<float>(std::max(0.0, room)));
    }
  }
  return out;
}

}  // namespace navvy::sim
