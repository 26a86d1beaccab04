// SPDX-License-Identifier: Apache-2.0
#include "sim/visible_soil.h"

#include <cmath>
#include <utility>

#include "sim/world_parts.h"

namespace navvy::sim {

VisibleSoil visible_soil(const World& world) {
  const heightfield::Ground& ground = world.ground();
  const std::vector<soil::Particle> particles = parts(world).soil.particles();
  heightfield::TerrainView columns = ground.view(world.time());
  if (particles.empty()) return {std::move(columns), Vec3::Zero(), {}};
  // Soil in a tool above a column is not on the column, however close it is.
  const std::vector<std::uint8_t> held = parts(world).coupling.held(particles);
  const double cell = ground.cell(), block = soil::kBlockCells * cell;
  const Vec3 grid = parts(world).soil.grid_origin();
  std::vector<Vec2i> column(particles.size());
  std::vector<float> volume(particles.size());
  std::vector<heightfield::LooseGrain> grains;
  const auto place_of = [&](const soil::Particle& p) {
    return Vec3(grid + block * Vec3(p.block[0], p.block[1], p.block[2]) +
                cell * Vec3(p.x[0], p.x[1], p.x[2]));
  };
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const soil::Particle& p = particles[i];
    const auto [ix, iy] = parts(world).soil.grid().column_of(p);
    column[i] = Vec2i(ix, iy);
    const double v = kilograms(p.mass) * static_cast<double>(p.j0) /
                     world.description().soils[p.soil].bank_density;
    volume[i] = static_cast<float>(v);
    if (held[i] == 0)
      grains.push_back(
          {ix, iy, place_of(p).z(), v, static_cast<std::uint16_t>(p.soil), p.j0, p.mass});
  }
  VisibleSoil out{columns.with(heightfield::LooseSoil(columns, std::move(grains))),
                  place_of(particles.front()),
                  {}};
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 p_W = place_of(particles[i]);
    // Particles below the surface are what makes it up.
    if (held[i] == 0 && p_W.z() <= out.surface.height(column[i].x(), column[i].y())) continue;
    const float radius = std::cbrt(volume[i] * static_cast<float>(0.75 / kPi));
    out.balls.push_back({(p_W - out.origin).cast<float>(), radius});
  }
  return out;
}

}  // namespace navvy::sim
