// SPDX-License-Identifier: Apache-2.0
#include "record/column_changes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace navvy::record {

heightfield::CellRect changed_rect(const heightfield::Ground& ground,
                                   const heightfield::LooseSoil& on_ground) {
  // Only columns that were touched or on which soil fell can have changed.
  heightfield::CellRect rect = ground.touched_rect();
  for (const heightfield::LooseSoil::Column& column : on_ground.columns())
    rect.include({column.ix, column.iy, column.ix + 1, column.iy + 1});
  return {std::max(rect.x0, 0), std::max(rect.y0, 0), std::min(rect.x1, ground.nx()),
          std::min(rect.y1, ground.ny())};
}

void for_each_changed_column(const sim::World& world, const heightfield::LooseSoil& on_ground,
                             const std::function<void(const ColumnChange&)>& use) {
  const heightfield::Ground& ground = world.ground();
  const std::size_t soils = ground.setup().soils.size();
  // Active soil by column.
  std::map<std::pair<int, int>, std::vector<std::int64_t>> active;
  for (const heightfield::LooseGrain& grain : on_ground.grains()) {
    std::vector<std::int64_t>& masses = active[{grain.ix, grain.iy}];
    masses.resize(soils);
    masses[grain.soil] += grain.mass;
  }
  const heightfield::CellRect rect = changed_rect(ground, on_ground);
  std::vector<heightfield::SoilLayer> now, start;
  ColumnChange change;
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      ground.column(ix, iy, now);
      ground.start_column(ix, iy, start);
      change.ix = ix;
      change.iy = iy;
      change.gain.assign(soils, 0);
      for (const heightfield::SoilLayer& layer : now) change.gain[layer.soil] += layer.mass;
      for (const heightfield::SoilLayer& layer : start) change.gain[layer.soil] -= layer.mass;
      if (const auto above = active.find({ix, iy}); above != active.end())
        for (std::size_t i = 0; i < soils; ++i) change.gain[i] += above->second[i];
      use(change);
    }
}

}  // namespace navvy::record
