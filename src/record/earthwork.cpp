// SPDX-License-Identifier: Apache-2.0
#include "record/earthwork.h"

#include <algorithm>

#include "record/column_changes.h"
#include "sim/world_terrain.h"

namespace navvy::record {

Earthwork measure_earthwork(const sim::World& world) {
  return measure_earthwork(world, sim::active_places(world).on_ground);
}

Earthwork measure_earthwork(const sim::World& world, const heightfield::LooseSoil& on_ground) {
  const heightfield::Ground& ground = world.ground();
  const std::vector<scene::Soil>& soils = ground.setup().soils;
  const heightfield::TerrainView surface =
      ground.view(world.time()).with(on_ground, heightfield::SurfaceKind::kMapped);
  Earthwork sum;
  sum.soils.resize(soils.size());
  const double area = ground.cell() * ground.cell();
  // A threshold of a twentieth of a cell keeps rounding errors of activated and deposited columns
  // out of the sums.
  const double least = 0.05 * area * ground.cell();
  for_each_changed_column(world, on_ground, [&](const ColumnChange& column) {
    double gain = 0;
    // Soils are compared one by one: a layer that was dug and another that was dumped in its place
    // are both earthwork.
    for (std::size_t i = 0; i < soils.size(); ++i) {
      const double change = kilograms(column.gain[i]) / soils[i].bank_density;
      gain += change;
      if (change < -least) sum.soils[i].dug -= change * soils[i].bank_density;
      if (change > least) sum.soils[i].spoil += change * soils[i].bank_density;
    }
    // Volumes are those of whole columns: bank volume where a column lost mass, the rise of the
    // surface where it gained mass. Spoil that a wheel compacted may be lower than the ground was,
    // and counts as zero.
    if (gain < -least) sum.bank_volume -= gain;
    if (gain > least)
      sum.loose_volume += area * std::max(0.0, surface.height(column.ix, column.iy) -
                                                   surface.start_height(column.ix, column.iy));
  });
  return sum;
}

}  // namespace navvy::record
