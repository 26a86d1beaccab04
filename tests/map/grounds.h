// SPDX-License-Identifier: Apache-2.0
// Small sites and maps that the tests of this folder share.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "heightfield/layered_ground.h"
#include "heightfield/terrain_view.h"
#include "map/map_maker.h"

namespace navvy::map::testing {

/// Not square, no side a multiple of a tile, the origin on no column; 0.1 m columns of two soils.
inline heightfield::GroundSetup setup(int nx = 148, int ny = 84) {
  heightfield::GroundSetup out;
  out.nx = nx;
  out.ny = ny;
  out.cell = 0.1;
  out.origin = Vec2(-3.3, 1.7);
  out.datum = -4;
  out.soils.resize(2);
  out.soils[0].name = "loam";
  out.soils[0].bank_density = 1540;
  out.soils[1].name = "topsoil";
  out.soils[1].bank_density = 1100;
  out.layers = {{"topsoil", 0.3}, {"loam", 1}};
  out.surface = [](int, int) { return 0.0; };
  return out;
}

inline Vec2 centre(const heightfield::GroundSetup& s, int ix, int iy) {
  return s.origin + s.cell * Vec2(ix + 0.5, iy + 0.5);
}

/// Returns a map of the heights that `z` gives at column centres, with a flat start at 0 and all
/// derived layers.
inline TerrainMap map_of(heightfield::GroundSetup s, const std::function<double(double, double)>& z,
                         MapOptions options = {}) {
  const heightfield::GroundSetup place = s;
  s.surface = [place, z](int ix, int iy) {
    const Vec2 p = centre(place, ix, iy);
    return z(p.x(), p.y());
  };
  MapMaker maker(std::move(options));
  maker.update(heightfield::Ground(s).view());
  const std::vector<float> flat(static_cast<std::size_t>(s.nx) * static_cast<std::size_t>(s.ny),
                                0.0f);
  return maker.map().with(MapLayer::kElevationStart, flat);
}

}  // namespace navvy::map::testing
