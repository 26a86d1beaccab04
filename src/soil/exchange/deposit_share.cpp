// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/deposit_share.h"

#include <algorithm>

namespace navvy::soil {
namespace {

/// Where particles crowd into less volume than their state needs (beside plates the tracked volume
/// misses up to half of it), a block may rise above its surface by the first factor. The rest is
/// stored as density, down to the second value. Tuned: a blade drawn 2 m through sand leaves every
/// block but the three it stood in within 0.85 .. 1.15.
constexpr double kMostRise = 1.15, kCrowded = 0.8;

}  // namespace

std::vector<SoilShare> soil_shares(const ColumnIndex& index,
                                   std::span<const std::uint32_t> grains) {
  // Few soils meet in a block, so the list is searched.
  std::vector<SoilShare> out;
  for (const std::uint32_t i : grains) {
    const Particle& p = index[i];
    auto share =
        std::find_if(out.begin(), out.end(), [&](const SoilShare& s) { return s.soil == p.soil; });
    if (share == out.end()) {
      out.push_back({p.soil});
      share = out.end() - 1;
    }
    share->mass += p.mass;
    share->volume += static_cast<double>(p.mass) * static_cast<double>(p.j0);
    share->shear += static_cast<double>(p.mass) * static_cast<double>(p.shear);
    share->height += static_cast<double>(p.mass) * height_in_cells(p);
  }
  // Soil that was lower on average stays below. Equal heights are ordered by the soil's number, so
  // that the order is the same in every run.
  std::sort(out.begin(), out.end(), [](const SoilShare& a, const SoilShare& b) {
    const double za = a.height / static_cast<double>(a.mass),
                 zb = b.height / static_cast<double>(b.mass);
    return za != zb ? za < zb : a.soil < b.soil;
  });
  return out;
}

heightfield::SoilLayer layer_of(const SoilShare& share, double swell, double densest, double rise) {
  const double mass = static_cast<double>(share.mass);
  heightfield::SoilLayer layer;
  layer.soil = share.soil;
  // The limits are wide on purpose: tighter ones turn noise into volume
  // [docs/exchange.md, decisions].
  double state = std::clamp(share.volume / mass, densest, swell);
  if (rise > kMostRise) state = std::max(state * kMostRise / rise, kCrowded);
  layer.specific_volume = static_cast<float>(state);
  layer.plastic_shear = static_cast<float>(share.shear / mass);
  return layer;
}

void share_out(heightfield::Ground& ground, heightfield::SoilLayer layer, std::int64_t mass,
               std::span<const SharedColumn> columns) {
  const auto largest = std::max_element(
      columns.begin(), columns.end(),
      [](const SharedColumn& a, const SharedColumn& b) { return a.weight < b.weight; });
  std::int64_t sum = 0;
  for (const SharedColumn& column : columns) sum += column.weight;
  // The product may need more than 64 bits; doubles would lose quanta.
  __extension__ using Wide = __int128;
  const auto part = [&](const SharedColumn& column) {
    return static_cast<std::int64_t>(static_cast<Wide>(mass) * column.weight / sum);
  };
  std::int64_t left = mass;
  for (const SharedColumn& column : columns) left -= part(column);
  for (const SharedColumn& column : columns) {
    layer.mass = part(column) + (&column == &*largest ? left : 0);
    // Avoids empty layers.
    if (layer.mass > 0) ground.put(column.ix, column.iy, layer);
  }
}

}  // namespace navvy::soil
