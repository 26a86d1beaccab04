// SPDX-License-Identifier: Apache-2.0
// What a column is made of.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// One soil layer of a column. Its thickness is mass x specific_volume / (bank_density x cell^2).
struct SoilLayer {
  std::uint16_t soil = 0;     ///< index into the scene's soils
  std::int64_t mass = 0;      ///< in kMassQuantum
  float specific_volume = 1;  ///< volume / bank volume: 1 = bank, up to the soil's swell
  float plastic_shear = 0;    ///< accumulated, for remoulded cohesion [-]
};

/// Layers from the bottom up.
using Column = std::vector<SoilLayer>;

}  // namespace navvy::heightfield
