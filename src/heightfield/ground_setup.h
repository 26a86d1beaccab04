// SPDX-License-Identifier: Apache-2.0
// What a site is before anybody digs: its size, its soils and where its surface comes from.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/ground.h"
#include "scene/soil.h"

namespace navvy::heightfield {

/// Where the untouched surface comes from: height [m] of the bank surface in W at a column centre,
/// any (ix, iy) of the site. Must be a pure function that several threads may call at a time: tiles
/// are made from it when first read.
using SurfaceSource = std::function<double(int ix, int iy)>;

/// Grid, soils and georeference of a site. Column (0, 0) has least x and least y, x runs fastest,
/// the centre of column (ix, iy) lies at origin + ((ix, iy) + 0.5) cell.
struct GroundSetup {
  int nx = 0, ny = 0;          ///< columns
  double cell = 0.1;           ///< [m]
  Vec2 origin = Vec2::Zero();  ///< W of the site's lower-left corner [m]
  double datum = 0;            ///< W height of bedrock, where every column starts [m]
  std::vector<scene::Soil> soils;
  std::vector<scene::GroundLayer> layers;  ///< from the surface down
  std::vector<scene::GroundPatch> patches;
  SurfaceSource surface;
  /// Of the heights that `surface` takes from a map; 0: from the scene's numbers alone.
  std::uint64_t map_hash = 0;
  // Georeference of the site, for exports: file coordinates of `origin`, and its CRS as WKT (empty:
  // none). File z [m] = W z + height_offset; the file may count in feet.
  double easting = 0, northing = 0, height_offset = 0;
  /// Metres per unit of the file's coordinates and heights.
  double file_unit = 1, file_height_unit = 1;
  std::string crs_wkt;
  // Of a map with gaps: heights there were made up from the nearest known ones.
  double filled_share = 0;  ///< of the map's cells on the site, 0 .. 1
  double filled_from = 0;   ///< most of the distances to a cell with a height [m]
};

}  // namespace navvy::heightfield
