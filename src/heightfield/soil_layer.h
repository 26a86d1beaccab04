// SPDX-License-Identifier: Apache-2.0
// A soil layer, and a column as a stack of layers.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// One soil layer of a terrain column. Its thickness is mass * specific_volume / (bank_density *
/// cell^2).
struct SoilLayer {
  /// Index of the layer's soil in the scene's list of soils.
  std::uint16_t soil = 0;
  /// Mass of the layer [kMassQuantum].
  std::int64_t mass = 0;
  /// Volume divided by bank volume [-]: 1 for undisturbed soil, up to the soil's swell factor for
  /// loose soil.
  float specific_volume = 1;
  /// Accumulated plastic shear strain [-], which determines how far the soil is remoulded and so
  /// its cohesion.
  float plastic_shear = 0;
};

/// The layers of one terrain column, from bottom to top.
using Column = std::vector<SoilLayer>;

}  // namespace navvy::heightfield
