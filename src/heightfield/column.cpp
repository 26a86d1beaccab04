// SPDX-License-Identifier: Apache-2.0
// Layers are cut, added and compacted in whole units of mass: soil that leaves one column arrives
// in another to the last unit, whatever rounding its thickness suffers.
#include "heightfield/column.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace navvy::heightfield {
namespace {

// Layers whose specific volumes agree this well are merged.
constexpr float kSameSpecificVolume = 1e-3f;
// The same for plastic shear: cohesion over this span of the remoulding law differs by less than a
// fifth.
constexpr float kSameShear = 0.05f;
// Beyond this shear the soil is fully remoulded, and differences have no effect.
constexpr float kFullShear = 4.0f;
// A smaller rest of a drop is rounding error of doubles, and thinner than a unit of mass [m].
constexpr double kNoDrop = 1e-9;
// With more layers than this, similar neighbours are united. tuned:
// Ground.StaysShortUnderEndlessEdits
constexpr std::size_t kMostLayers = 12;

// Returns true for layers so similar that merging them has no noticeable effect.
bool mergeable(const SoilLayer& a, const SoilLayer& b) {
  return a.soil == b.soil &&
         std::abs(a.specific_volume - b.specific_volume) <= kSameSpecificVolume &&
         std::abs(std::min(a.plastic_shear, kFullShear) - std::min(b.plastic_shear, kFullShear)) <=
             kSameShear;
}

// Adds b to a: masses and volumes add, shear is the mass mean.
void unite(SoilLayer& a, const SoilLayer& b) {
  // Volume acts on neighbours, so volumes add; shear is a memory of the material and follows the
  // mass.
  const double ma = static_cast<double>(a.mass), mb = static_cast<double>(b.mass), m = ma + mb;
  a.specific_volume = static_cast<float>((ma * a.specific_volume + mb * b.specific_volume) / m);
  a.plastic_shear = static_cast<float>((ma * a.plastic_shear + mb * b.plastic_shear) / m);
  a.mass += b.mass;
}

// Unites the two neighbours of one soil that differ least; does nothing in a column whose soils
// alternate.
void shorten(Column& column) {
  std::size_t best = column.size();
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i + 1 < column.size(); ++i) {
    const SoilLayer &a = column[i], &b = column[i + 1];
    if (a.soil != b.soil) continue;
    const float difference = std::abs(a.specific_volume - b.specific_volume);
    if (difference < least) {
      least = difference;
      best = i;
    }
  }
  if (best == column.size()) return;
  unite(column[best], column[best + 1]);
  column.erase(column.begin() + static_cast<std::ptrdiff_t>(best) + 1);
}

// Splits layer `i` so that `top` [m] of it becomes layer i + 1.
void split(Column& column, std::size_t i, double top, const UnitThickness& unit) {
  // Masses are rounded; the two halves sum to the whole.
  SoilLayer upper = column[i];
  upper.mass = std::llround(top / (static_cast<double>(upper.specific_volume) * unit[upper.soil]));
  upper.mass = std::clamp<std::int64_t>(upper.mass, 0, column[i].mass);
  column[i].mass -= upper.mass;
  column.insert(column.begin() + static_cast<std::ptrdiff_t>(i) + 1, upper);
}

// See compact.
void press(Column& column, double drop, double zone, float min_specific_volume,
           const UnitThickness& unit) {
  for (std::size_t i = column.size(); i-- > 0 && drop > kNoDrop;) {
    // Splits only a thick layer: the next pass of the same wheel finds its zone cut already.
    if (thickness(column[i], unit) > 1.5 * zone) {
      split(column, i, zone, unit);
      ++i;
    }
    // Works from the surface down, until the drop is used up or all soil has its greatest density.
    SoilLayer& layer = column[i];
    if (layer.mass == 0 || layer.specific_volume <= min_specific_volume) continue;
    const double old = thickness(layer, unit);
    const double least = old * (static_cast<double>(min_specific_volume) / layer.specific_volume);
    const double target = std::max(old - drop, least);
    layer.specific_volume = target == least
                                ? min_specific_volume
                                : static_cast<float>(layer.specific_volume * (target / old));
    drop -= old - target;
  }
  // A split may leave an empty layer, and the splits of many passes add up.
  std::erase_if(column, [](const SoilLayer& layer) { return layer.mass == 0; });
  while (column.size() > kMostLayers) {
    const std::size_t before = column.size();
    shorten(column);
    if (column.size() == before) break;
  }
}

}  // namespace

void take_above(Column& column, double height, const UnitThickness& unit,
                std::vector<SoilLayer>& taken) {
  // Cuts the first layer that reaches above the height.
  double bottom = 0;
  std::size_t i = 0;
  while (i < column.size()) {
    const double top = bottom + thickness(column[i], unit);
    if (top > height) break;
    bottom = top;
    ++i;
  }
  if (i == column.size()) return;
  // The cut layer keeps its rounded share and the rest is taken, so that no unit is lost.
  SoilLayer& cut = column[i];
  const double share =
      (height - bottom) / (static_cast<double>(cut.specific_volume) * unit[cut.soil]);
  const std::int64_t lower_mass =
      height <= bottom ? 0 : std::clamp<std::int64_t>(std::llround(share), 0, cut.mass);
  SoilLayer upper = cut;
  upper.mass -= lower_mass;
  cut.mass = lower_mass;
  if (upper.mass > 0) taken.push_back(upper);
  taken.insert(taken.end(), column.begin() + static_cast<std::ptrdiff_t>(i) + 1, column.end());
  column.resize(lower_mass > 0 ? i + 1 : i);
}

// Merging on deposition keeps columns short: soil is put back in small amounts.
void put(Column& column, const SoilLayer& layer) {
  if (!column.empty() && mergeable(column.back(), layer)) {
    unite(column.back(), layer);
    return;
  }
  column.push_back(layer);
  if (column.size() > kMostLayers) shorten(column);
}

// Walks down through the zone and then through deeper soil, until the drop is used up.
void compact(Column& column, double drop, double zone, float min_specific_volume,
             const UnitThickness& unit) {
  // Splits may need several times the capacity of the final layers, which the column would keep.
  thread_local Column work;
  work = column;
  press(work, drop, zone, min_specific_volume, unit);
  column = work;
}

}  // namespace navvy::heightfield
