// SPDX-License-Identifier: Apache-2.0
// What can be mapped: one function a layer, and the table that names them.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "heightfield/map_view.h"

namespace navvy::heightfield {
namespace {

// Normal at a column from its neighbours, central differences; one-sided at the edge of the site.
Vec3 normal_at(const Terrain& terrain, int ix, int iy) {
  const int x0 = std::max(ix - 1, 0), x1 = std::min(ix + 1, terrain.nx() - 1);
  const int y0 = std::max(iy - 1, 0), y1 = std::min(iy + 1, terrain.ny() - 1);
  const double dx =
      x1 > x0 ? (terrain.height(x1, iy) - terrain.height(x0, iy)) / ((x1 - x0) * terrain.cell())
              : 0;
  const double dy =
      y1 > y0 ? (terrain.height(ix, y1) - terrain.height(ix, y0)) / ((y1 - y0) * terrain.cell())
              : 0;
  return Vec3(-dx, -dy, 1).normalized();
}

// Every function is asked for columns of the site only.
double elevation(const Terrain& terrain, int ix, int iy) { return terrain.height(ix, iy); }

double change(const Terrain& terrain, int ix, int iy) {
  return terrain.height(ix, iy) - terrain.start_height(ix, iy);
}

// From the normal, so that the two layers of one map always agree.
double slope(const Terrain& terrain, int ix, int iy) {
  const Vec3 n = normal_at(terrain, ix, iy);
  return std::atan2(n.head<2>().norm(), n.z());
}

double normal_x(const Terrain& terrain, int ix, int iy) { return normal_at(terrain, ix, iy).x(); }
double normal_y(const Terrain& terrain, int ix, int iy) { return normal_at(terrain, ix, iy).y(); }
double normal_z(const Terrain& terrain, int ix, int iy) { return normal_at(terrain, ix, iy).z(); }

double soil(const Terrain& terrain, int ix, int iy) { return terrain.surface_soil(ix, iy); }

// Above 1 where soil was dug and loosened, below where it was pressed.
double specific_volume(const Terrain& terrain, int ix, int iy) {
  return terrain.specific_volume(ix, iy);
}

double loose_depth(const Terrain& terrain, int ix, int iy) { return terrain.loose_depth(ix, iy); }

// As a number, so that every layer is a map of floats.
double active(const Terrain& terrain, int ix, int iy) { return terrain.active(ix, iy) ? 1 : 0; }

}  // namespace

const std::vector<MapLayer>& map_layers() {
  static const std::vector<MapLayer> table = {
      {"elevation", "m", "height of the surface in W", elevation},
      {"change", "m", "height now minus height at the start", change},
      {"slope", "rad", "angle of the surface from the horizontal", slope},
      {"normal_x", "-", "unit upward normal in W, x", normal_x},
      {"normal_y", "-", "unit upward normal in W, y", normal_y},
      {"normal_z", "-", "unit upward normal in W, z", normal_z},
      {"soil", "-", "index of the soil at the surface", soil},
      {"specific_volume", "-", "volume over bank volume at the surface", specific_volume},
      {"loose_depth", "m", "depth of loose soil that lies on the columns", loose_depth},
      {"awake", "-", "1 where that soil may still move, 0 elsewhere", active},
  };
  return table;
}

const MapLayer& map_layer(const std::string& name) {
  const auto& layers = map_layers();
  const auto found = std::find_if(layers.begin(), layers.end(),
                                  [&](const MapLayer& layer) { return layer.name == name; });
  if (found != layers.end()) return *found;
  std::string all;
  for (const MapLayer& each : layers) all += (all.empty() ? "" : ", ") + each.name;
  throw InputError(
      Fault{Fault::Severity::kError, "", 0, "map layer", name, "no such layer", "one of " + all});
}

}  // namespace navvy::heightfield
