// SPDX-License-Identifier: Apache-2.0
// Description of an untouched site: size, soils, and the source of its initial surface.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/ground.h"
#include "scene/soil.h"

namespace navvy::heightfield {

/// Function that returns the initial height of the ground, as world z [m], at the centre of site
/// column (ix, iy). It must be a pure function that several threads may call at the same time,
/// because tiles are computed on first access.
using SurfaceSource = std::function<double(int ix, int iy)>;

/// Grid, soils and georeference of a site. Column (0, 0) has the smallest x and y, and arrays of
/// columns are stored with x fastest. The centre of column (ix, iy) lies at world (x, y) = origin +
/// ((ix, iy) + 0.5) * cell.
struct GroundSetup {
  /// Number of columns along x (nx) and along y (ny).
  int nx = 0, ny = 0;
  /// Edge length of a column [m].
  double cell = 0.1;
  /// World (x, y) of the corner of the site with the smallest x and y [m].
  Vec2 origin = Vec2::Zero();
  /// World z of bedrock, which is the bottom of every column [m].
  double datum = 0;
  /// Soils of the scene. Soil layers refer to them by index.
  std::vector<scene::Soil> soils;
  /// Initial soil layers of the site, from the surface downwards.
  std::vector<scene::GroundLayer> layers;
  /// Rectangles of the site whose initial layers differ from `layers`. If patches overlap, the last
  /// one applies.
  std::vector<scene::GroundPatch> patches;
  /// Function that returns the initial height of each column.
  SurfaceSource surface;
  /// Hash of the file heights that `surface` interpolates; 0 if the surface depends on the scene
  /// only.
  std::uint64_t map_hash = 0;
  /// Georeference for exports: file coordinates of `origin` (`easting`, `northing`, in units of
  /// `file_unit`), and `height_offset` [m], such that file height = world z + height_offset, in
  /// metres.
  double easting = 0, northing = 0, height_offset = 0;
  /// Metres per unit of the file's horizontal coordinates (`file_unit`) and heights
  /// (`file_height_unit`). They differ from 1 for files in feet.
  double file_unit = 1, file_height_unit = 1;
  /// Coordinate reference system of the file as WKT; empty if it has none.
  std::string crs_wkt;
  /// Fraction of the file's cells on the site whose unknown heights were filled in from known
  /// neighbours, 0 to 1.
  double filled_share = 0;
  /// Largest distance from a filled cell to the nearest cell with a known height [m].
  double filled_from = 0;
};

}  // namespace navvy::heightfield
