// SPDX-License-Identifier: Apache-2.0
// Writes ground as GeoTIFF. Exists only in builds with NAVVY_WITH_GDAL.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// One band of a GeoTIFF, computed row by row.
struct MapBand {
  /// Name and unit in the file; heights take the unit of the file instead.
  std::string name, unit;
  /// Fills `out` with rows [y0, y1) of the site, row y0 (least y) first, x fastest; NaN becomes
  /// nodata. Called by one thread at a time, which may differ from the caller's.
  std::function<void(int y0, int y1, std::vector<float>& out)> rows;
  /// True for heights in W [m], which are written in the unit and vertical datum of the file.
  bool height = false;
};
/// Writes the present heights of the whole site as a float32 GeoTIFF (DEFLATE, PREDICTOR 3, nodata
/// -9999), north up, in the coordinates, units, CRS and vertical datum of the file that the site
/// came from, or in W. The band has the unit of the heights. The bands `more` follow with their
/// values unchanged; readers of heights take the first band.
///
/// The file is written strip by strip, so that a large site needs no copy; another thread computes
/// the next strips while GDAL compresses. A kill leaves the old file or the new one. For a site
/// whose map had gaps the metadata hold the share of its cells that were filled, 0 to 1
/// (NAVVY_FILLED_SHARE), and the largest distance to a known cell (NAVVY_FILLED_FROM_M).
/// @throws FileError naming path and cause.
void write_geotiff(const Terrain& terrain, const std::string& path,
                   const std::vector<MapBand>& more = {});

/// Writes bands of a whole site under their names, in the coordinates of `setup`.
/// @throws Error when sizes do not match or there is no band, FileError.
void write_geotiff(const GroundSetup& setup, const std::vector<MapBand>& bands,
                   const std::string& path);

}  // namespace navvy::heightfield
