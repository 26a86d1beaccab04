// SPDX-License-Identifier: Apache-2.0
#include "record/earthwork.h"

#include <algorithm>
#include <map>
#include <utility>

#include "sim/world_terrain.h"

namespace navvy::record {
namespace {

/// Computes the bank volume of each soil in a column [m3].
void bank_volumes(const std::vector<heightfield::SoilLayer>& column,
                  const std::vector<scene::Soil>& soils, std::vector<double>& volumes) {
  // The caller reuses the vector, as this is called for every changed column.
  volumes.assign(soils.size(), 0.0);
  for (const heightfield::SoilLayer& layer : column)
    volumes[layer.soil] += kilograms(layer.mass) / soils[layer.soil].bank_density;
}

}  // namespace

Earthwork measure_earthwork(const sim::World& world) {
  return measure_earthwork(world, sim::active_places(world).on_ground);
}

Earthwork measure_earthwork(const sim::World& world, const heightfield::LooseSoil& on_ground) {
  const heightfield::Ground& ground = world.ground();
  const std::vector<scene::Soil>& soils = ground.setup().soils;
  const heightfield::TerrainView surface =
      ground.view(world.time()).with(on_ground, heightfield::SurfaceKind::kMapped);
  std::map<std::pair<int, int>, std::vector<double>> active;  // bank volumes on columns [m3]
  for (const heightfield::LooseGrain& grain : on_ground.grains()) {
    std::vector<double>& volumes = active[{grain.ix, grain.iy}];
    volumes.resize(soils.size());
    volumes[grain.soil] += kilograms(grain.mass) / soils[grain.soil].bank_density;
  }
  Earthwork sum;
  sum.soils.resize(soils.size());
  // Only columns that were touched or on which soil fell can have changed.
  heightfield::CellRect rect = ground.touched_rect();
  for (const heightfield::LooseSoil::Column& column : on_ground.columns())
    rect.include({column.ix, column.iy, column.ix + 1, column.iy + 1});
  const double area = ground.cell() * ground.cell();
  // A threshold of a twentieth of a cell keeps rounding errors of activated and deposited columns
  // out of the sums.
  const double least = 0.05 * area * ground.cell();
  std::vector<heightfield::SoilLayer> now, start;
  std::vector<double> after, before;
  for (int iy = std::max(rect.y0, 0); iy < std::min(rect.y1, ground.ny()); ++iy)
    for (int ix = std::max(rect.x0, 0); ix < std::min(rect.x1, ground.nx()); ++ix) {
      ground.column(ix, iy, now);
      ground.start_column(ix, iy, start);
      bank_volumes(now, soils, after);
      bank_volumes(start, soils, before);
      const auto above = active.find({ix, iy});
      double gain = 0;
      // Soils are compared one by one: a layer that was dug and another that was dumped in its
      // place are both earthwork.
      for (std::size_t i = 0; i < soils.size(); ++i) {
        const double change =
            after[i] + (above == active.end() ? 0.0 : above->second[i]) - before[i];
        gain += change;
        if (change < -least) sum.soils[i].dug -= change * soils[i].bank_density;
        if (change > least) sum.soils[i].spoil += change * soils[i].bank_density;
      }
      // Volumes are those of whole columns: bank volume where a column lost mass, the rise of the
      // surface where it gained mass. Spoil that a wheel compacted may be lower than the ground
      // was, and counts as zero.
      if (gain < -least) sum.bank_volume -= gain;
      if (gain > least)
        sum.loose_volume +=
            area * std::max(0.0, surface.height(ix, iy) - surface.start_height(ix, iy));
    }
  return sum;
}

}  // namespace navvy::record
