// SPDX-License-Identifier: Apache-2.0
#include "sim/world_terrain.h"

#include <memory>
#include <utility>
#include <vector>

#include "sim/occupied_areas.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

/// Returns a particle as the heightfield needs it.
heightfield::LooseGrain grain_of(const World& world, const soil::Particle& p) {
  const heightfield::Ground& ground = world.ground();
  const auto [ix, iy] = parts(world).soil.grid().column_of(p);
  // Heights of particles are in cells above bedrock.
  const double z = ground.datum() +
                   ground.cell() * (p.block[2] * soil::kBlockCells + static_cast<double>(p.x[2]));
  const double volume = kilograms(p.mass) * static_cast<double>(p.j0) /
                        world.description().soils[p.soil].bank_density;
  return {ix, iy, z, volume, static_cast<std::uint16_t>(p.soil), p.j0, p.mass};
}

}  // namespace

// Tools first: soil in a bucket above a column is not on the column.
ActivePlaces active_places(const World& world) {
  const std::vector<soil::Particle> particles = parts(world).soil.particles();
  const std::vector<std::uint8_t> held = parts(world).coupling.held(particles);
  const std::size_t soils = world.description().soils.size();
  ActivePlaces out;
  out.resting.resize(soils);
  out.held.resize(soils);
  out.elsewhere.resize(soils);
  // Soil that no tool holds is elsewhere until it is found on a column.
  std::vector<heightfield::LooseGrain> grains;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    (held[i] != 0 ? out.held : out.elsewhere)[particles[i].soil] += particles[i].mass;
    if (held[i] == 0) grains.push_back(grain_of(world, particles[i]));
  }
  out.on_ground = heightfield::LooseSoil(world.ground(), std::move(grains));
  for (const heightfield::LooseGrain& grain : out.on_ground.grains()) {
    out.resting[grain.soil] += grain.mass;
    out.elsewhere[grain.soil] -= grain.mass;
  }
  return out;
}

// Only the surfaces with loose soil need the particles.
heightfield::TerrainView terrain_view(const World& world, heightfield::SurfaceKind surface) {
  heightfield::TerrainView columns = world.ground().view(world.time());
  if (surface == heightfield::SurfaceKind::kColumns) return columns;
  if (surface == heightfield::SurfaceKind::kMapped)
    return columns.with(active_places(world).on_ground, surface)
        .with(std::make_shared<const std::vector<heightfield::OccupiedArea>>(
            occupied_areas(world, all_bodies(world.description()))));
  std::vector<heightfield::LooseGrain> grains;
  for (const soil::Particle& p : parts(world).soil.particles())
    grains.push_back(grain_of(world, p));
  return columns.with(heightfield::LooseSoil(columns, std::move(grains)), surface);
}

}  // namespace navvy::sim
