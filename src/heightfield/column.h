// SPDX-License-Identifier: Apache-2.0
// Operations on one terrain column, which is a stack of soil layers stored from bottom to top. All
// are pure functions, and masses are exact integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/soil_layer.h"

namespace navvy::heightfield {

/// Thickness of one mass unit (kMassQuantum) in a column at bank density [m], one entry per soil:
/// kMassQuantum / (bank_density * cell^2).
using UnitThickness = std::vector<double>;

/// Returns the thickness of one soil layer [m].
inline double thickness(const SoilLayer& layer, const UnitThickness& unit) {
  return static_cast<double>(layer.mass) * static_cast<double>(layer.specific_volume) *
         unit[layer.soil];
}

/// Returns the height of the top of a column above bedrock [m], summed over `layers` from bottom to
/// top. All heights are computed by this function, so that equal layers have bit-identical heights.
inline double column_height(std::span<const SoilLayer> layers, const UnitThickness& unit) {
  double height = 0;
  for (const SoilLayer& layer : layers) height += thickness(layer, unit);
  return height;
}

/// Removes all soil above `height` [m above bedrock] from `column` and appends it to `taken`, from
/// bottom to top. A layer that crosses `height` is split at a whole mass unit.
void take_above(Column& column, double height, const UnitThickness& unit,
                std::vector<SoilLayer>& taken);

/// Adds `layer` on top of `column`. It is merged with the top layer if soil, specific volume and
/// plastic shear are nearly equal. In a column of more than 12 layers, the two most similar
/// neighbours of the same soil are merged, so that columns stay short.
void put(Column& column, const SoilLayer& layer);

/// Lowers the top of `column` by `drop` [m] by increasing the density of the uppermost `zone` [m]
/// of soil, and of deeper soil if that is not enough. No layer is compacted below
/// `min_specific_volume` (volume / bank volume), so the column may end up higher than requested.
void compact(Column& column, double drop, double zone, float min_specific_volume,
             const UnitThickness& unit);

}  // namespace navvy::heightfield
