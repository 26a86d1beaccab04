// SPDX-License-Identifier: Apache-2.0
#include "heightfield/loose_soil.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace navvy::heightfield {
// Sorts the grains by column and height, and stacks them from below.
LooseSoil::LooseSoil(const Terrain& columns, std::vector<LooseGrain> grains) {
  // Soil beyond the edge of the site has no column to rest on.
  std::erase_if(grains,
                [&](const LooseGrain& grain) { return !columns.contains(grain.ix, grain.iy); });
  const auto before = [](const LooseGrain& a, const LooseGrain& b) {
    return std::tie(a.iy, a.ix, a.z) < std::tie(b.iy, b.ix, b.z);
  };
  // Scans pass them in order.
  if (!std::is_sorted(grains.begin(), grains.end(), before))
    std::sort(grains.begin(), grains.end(), before);
  const double area = columns.cell() * columns.cell(), gap = kLooseGap * columns.cell();
  // Grains that rest move up to the place of those that do not.
  std::size_t resting = 0;
  for (std::size_t i = 0; i < grains.size();) {
    const int ix = grains[i].ix, iy = grains[i].iy;
    // Stacks the grains of one column from its resting surface up.
    const double bottom = columns.height(ix, iy);
    Column column{ix, iy, bottom, 0, 0, 1};
    for (; i < grains.size() && grains[i].ix == ix && grains[i].iy == iy; ++i) {
      if (!(grains[i].z < column.top + gap)) continue;
      column.top += grains[i].volume / area;
      column.soil = grains[i].soil;
      column.specific_volume = grains[i].specific_volume;
      grains[resting++] = grains[i];
    }
    column.depth = column.top - bottom;
    // If all of it is in the air, the column itself is visible.
    if (column.depth > 0) columns_.push_back(column);
  }
  grains.resize(resting);
  grains_ = std::move(grains);
}

}  // namespace navvy::heightfield
