// SPDX-License-Identifier: Apache-2.0
// The untouched site: its size, its soils and the source of its surface.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/ground.h"
#include "scene/soil.h"

namespace navvy::heightfield {

/// Source of the untouched surface: returns the height [m] of the bank surface in W at the centre
/// of a column (ix, iy) of the site. It must be a pure function that several threads may call at a
/// time, because tiles are made from it when they are first read.
using SurfaceSource = std::function<double(int ix, int iy)>;

/// Grid, soils and georeference of a site. Column (0, 0) has least x and least y, x runs fastest,
/// and the centre of column (ix, iy) lies at origin + ((ix, iy) + 0.5) cell.
struct GroundSetup {
  /// Number of columns along x and y.
  int nx = 0, ny = 0;
  /// Edge of a column [m].
  double cell = 0.1;
  /// Lower-left corner of the site in W [m].
  Vec2 origin = Vec2::Zero();
  /// Height of bedrock in W, where every column starts [m].
  double datum = 0;
  /// Soils of the scene; layers refer to them by index.
  std::vector<scene::Soil> soils;
  /// Layers from the surface down.
  std::vector<scene::GroundLayer> layers;
  /// Rectangles with layers of their own.
  std::vector<scene::GroundPatch> patches;
  /// Height of the untouched surface.
  SurfaceSource surface;
  /// Hash of the heights that `surface` takes from a map; 0 when it depends on the scene alone.
  std::uint64_t map_hash = 0;
  // Georeference for exports: file coordinates of `origin`, and file z = W z + height_offset [m].
  // The file may count in feet.
  double easting = 0, northing = 0, height_offset = 0;
  /// Metres per unit of the coordinates and of the heights in the file.
  double file_unit = 1, file_height_unit = 1;
  /// CRS of the file as WKT; empty where there is none.
  std::string crs_wkt;
  /// Share of the map's cells on the site whose heights were filled in from the nearest known ones,
  /// 0 to 1.
  double filled_share = 0;
  /// Largest distance from such a cell to a known one [m].
  double filled_from = 0;
};

}  // namespace navvy::heightfield
