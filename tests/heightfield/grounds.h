// SPDX-License-Identifier: Apache-2.0
// Small grounds that the tests of this folder share.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "heightfield/layered_ground.h"

namespace navvy::heightfield::testing {

inline scene::Soil soil(const char* name, double density) {
  scene::Soil s;
  s.name = name;
  s.bank_density = density;
  return s;
}

/// Returns topsoil 0.3 m over loam over a fixed datum at -3 m; not square, neither side a multiple
/// of the tile.
inline Ground::Setup wavy_setup(int nx = 77, int ny = 45) {
  Ground::Setup setup;
  setup.nx = nx;
  setup.ny = ny;
  setup.cell = 0.1;
  setup.origin = Vec2(-3.3, 1.7);
  setup.datum = -3;
  setup.soils = {soil("loam", 1540), soil("topsoil", 1100)};
  setup.layers = {{"topsoil", 0.3}, {"loam", 1}};
  setup.surface = [](int ix, int iy) {
    return 0.3 * std::sin(0.11 * ix) + 0.2 * std::cos(0.07 * iy) + 0.01 * ix;
  };
  return setup;
}

inline std::int64_t total(const std::vector<SoilLayer>& layers) {
  std::int64_t mass = 0;
  for (const SoilLayer& layer : layers) mass += layer.mass;
  return mass;
}

}  // namespace navvy::heightfield::testing
