// SPDX-License-Identifier: Apache-2.0
#include "sim/terrain_view.h"

#include <utility>
#include <vector>

#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

/// The particles as the heightfield sees them.
std::vector<heightfield::LooseGrain> loose_grains(const World& world) {
  const heightfield::Ground& ground = world.ground();
  const std::vector<scene::Soil>& soils = world.description().soils;
  std::vector<heightfield::LooseGrain> grains;
  for (const soil::Particle& p : parts(world).soil.particles()) {
    const auto [ix, iy] = parts(world).soil.grid().column_of(p);
    // Heights of particles are counted in cells from bedrock.
    const double z = ground.datum() + ground.cell() * (p.block[2] * soil::kBlockCells + static_cast<double>(p.x[2]));
    const double volume = kilograms(p.mass) * static_cast<double>(p.j0) / soils[p.soil].bank_density;
    grains.push_back({ix, iy, z, volume, static_cast<std::uint16_t>(p.soil), p.j0});
  }
  return grains;
}

}  // namespace

heightfield::TerrainView terrain_view(const World& world, heightfield::SurfaceKind surface) {
  heightfield::TerrainView columns = world.ground().view(world.time());
  if (surface == heightfield::SurfaceKind::kColumns) return columns;
  return columns.with(heightfield::LooseSoil(columns, loose_grains(world)));
}

}  // namespace navvy::sim
