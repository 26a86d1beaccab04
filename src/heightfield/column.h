// SPDX-License-Identifier: Apache-2.0
// Operations on one column, a stack of soil layers, bottom first. All are pure functions, and
// masses are exact integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/soil_layer.h"

namespace navvy::heightfield {

/// Thickness [m] of one mass unit at specific volume 1, per soil: kMassQuantum / (bank_density
/// cell^2).
using UnitThickness = std::vector<double>;

/// Returns the thickness of one layer [m].
inline double thickness(const SoilLayer& layer, const UnitThickness& unit) {
  return static_cast<double>(layer.mass) * static_cast<double>(layer.specific_volume) *
         unit[layer.soil];
}

/// Returns the height of the column above its bottom [m], summed from the bottom up. All heights
/// come from this function, so that equal layers always give equal bits.
inline double column_height(std::span<const SoilLayer> layers, const UnitThickness& unit) {
  double height = 0;
  for (const SoilLayer& layer : layers) height += thickness(layer, unit);
  return height;
}

/// Moves everything above `height` [m above the bottom] from `column` to the end of `taken`, bottom
/// first.
void take_above(Column& column, double height, const UnitThickness& unit,
                std::vector<SoilLayer>& taken);

/// Adds `layer` on top and merges it with the top layer when both are alike. A column with very
/// many layers unites neighbours, so that it stays short however often it is worked.
void put(Column& column, const SoilLayer& layer);

/// Lowers the column by `drop` [m] by raising the density of its uppermost `zone` [m], and of
/// deeper soil where that does not suffice. No layer falls below `min_specific_volume`.
void compact(Column& column, double drop, double zone, float min_specific_volume,
             const UnitThickness& unit);

}  // namespace navvy::heightfield
