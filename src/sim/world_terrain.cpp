// SPDX-License-Identifier: Apache-2.0
#include "sim/world_terrain.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "sim/column_list.h"
#include "sim/occupied_areas.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

/// Returns a particle on its column as the heightfield needs it.
heightfield::LooseGrain grain_of(const World& world, const ListedParticle& one,
                                 const soil::ParticlePlace& p) {
  const auto nx = static_cast<std::uint32_t>(world.ground().nx());
  const double volume = kilograms(p.mass) * static_cast<double>(p.j0) /
                        world.description().soils[p.soil].bank_density;
  return {static_cast<int>(one.column % nx),
          static_cast<int>(one.column / nx),
          one.z,
          volume,
          p.soil,
          p.j0,
          p.mass};
}

/// Returns the particles on the site for which `wanted` returns true, as LooseSoil needs them. It
/// is called once per particle.
template <class Wanted>
std::vector<heightfield::LooseGrain> grains(const World& world, const Wanted& wanted) {
  std::vector<soil::ParticlePlace> places;
  parts(world).soil.places(places);
  ColumnList list;
  list.take(world, places, wanted);
  list.drop_beyond();
  // LooseSoil would sort them, too, but larger items.
  list.sort_by_height(places);
  std::vector<heightfield::LooseGrain> out;
  out.reserve(list.particles().size());
  for (const ListedParticle& one : list.particles())
    out.push_back(grain_of(world, one, places[one.particle]));
  return out;
}

}  // namespace

// Tools first: soil in a bucket above a column is not on the column.
ActivePlaces active_places(const World& world) {
  const std::size_t soils = world.description().soils.size();
  ActivePlaces out;
  out.resting.resize(soils);
  out.held.resize(soils);
  out.elsewhere.resize(soils);
  const std::function<bool(const Vec3&)> holds = parts(world).coupling.holding();
  const Vec3& origin = parts(world).soil.grid_origin();
  const double cell = world.ground().cell();
  // Soil that no tool holds is elsewhere until it is found on a column.
  out.on_ground =
      heightfield::LooseSoil(world.ground(), grains(world, [&](const soil::ParticlePlace& p) {
                               const bool held = holds(origin + cell * p.grid);
                               (held ? out.held : out.elsewhere)[p.soil] += p.mass;
                               return !held;
                             }));
  for (const heightfield::LooseGrain& grain : out.on_ground.grains()) {
    out.resting[grain.soil] += grain.mass;
    out.elsewhere[grain.soil] -= grain.mass;
  }
  return out;
}

heightfield::TerrainView mapped_surface(const World& world) {
  return world.ground()
      .view(world.time())
      .with(active_places(world).on_ground, heightfield::SurfaceKind::kMapped);
}

// Only the surfaces with loose soil need the particles.
heightfield::TerrainView terrain_view(const World& world, heightfield::SurfaceKind surface) {
  const heightfield::TerrainView columns = world.ground().view(world.time());
  if (surface == heightfield::SurfaceKind::kColumns) return columns;
  if (surface == heightfield::SurfaceKind::kMapped)
    return mapped_surface(world).with(
        std::make_shared<const std::vector<heightfield::OccupiedArea>>(
            occupied_areas(world, all_bodies(world.description()))));
  const auto all = [](const soil::ParticlePlace&) { return true; };
  return columns.with(heightfield::LooseSoil(columns, grains(world, all)), surface);
}

}  // namespace navvy::sim
