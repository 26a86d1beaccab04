// SPDX-License-Identifier: Apache-2.0
// The layers of a column.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::heightfield {

/// One soil layer of a column. Its thickness is mass x specific_volume / (bank_density x cell^2).
struct SoilLayer {
  /// Index into the soils of the scene.
  std::uint16_t soil = 0;
  /// Mass [kMassQuantum].
  std::int64_t mass = 0;
  /// Volume over bank volume: 1 in the bank, up to the swell of the soil.
  float specific_volume = 1;
  /// Accumulated plastic shear, which decides the remoulded cohesion [-].
  float plastic_shear = 0;
};

/// The layers of a column, bottom first.
using Column = std::vector<SoilLayer>;

}  // namespace navvy::heightfield
