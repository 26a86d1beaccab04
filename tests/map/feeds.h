// SPDX-License-Identifier: Apache-2.0
// Ground with scattered changes, and maps of it with two layers.
#pragma once

#include <vector>

#include "core/random.h"
#include "heightfield/layered_ground.h"
#include "map/map_maker.h"

namespace navvy::map::testing {

inline const std::vector<MapLayer> kTwo = {MapLayer::kElevation, MapLayer::kSlope};

inline MapOptions two_layers() {
  MapOptions out;
  out.layers = kTwo;
  return out;
}

/// Digs a small pit, deeper each time at the same place.
inline void dig(heightfield::Ground& ground, Random& random, int& number) {
  std::vector<heightfield::SoilLayer> taken;
  const int x0 = static_cast<int>(random.uniform(0, ground.nx() - 4)),
            y0 = static_cast<int>(random.uniform(0, ground.ny() - 4));
  ++number;
  for (int iy = y0; iy < y0 + 4; ++iy)
    for (int ix = x0; ix < x0 + 4; ++ix)
      ground.take_above(ix, iy, ground.height(ix, iy) - 0.001, taken);
}

}  // namespace navvy::map::testing
