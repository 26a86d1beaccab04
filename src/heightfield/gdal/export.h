// SPDX-License-Identifier: Apache-2.0
// Writes the ground and map layers as GeoTIFF. Only in builds with NAVVY_WITH_GDAL.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// One band of a GeoTIFF file, computed a few rows at a time.
struct MapBand {
  /// Name and unit of the band in the file. The unit of a height band is that of the file's heights
  /// instead.
  std::string name, unit;
  /// Function that fills `out` with the site rows y0 <= iy < y1, row y0 (smallest y) first, x
  /// fastest. NaN is written as nodata. Only one thread at a time calls it, possibly another one
  /// than the caller of `write_geotiff`.
  std::function<void(int y0, int y1, std::vector<float>& out)> rows;
  /// True if the values are world z [m]. They are then converted to the unit and the vertical datum
  /// of the file.
  bool height = false;
};
/// Writes the current heights of the whole site to `path` as a float32 GeoTIFF with north at the
/// top (DEFLATE, PREDICTOR 3, nodata -9999). Coordinates, units, CRS and vertical datum are those
/// of the site's terrain file, or those of the world frame W if it has none. The heights are the
/// first band; the bands in `more` follow.
///
/// The file is written strip by strip, so that a large site needs no copy in memory; a second
/// thread computes the next strips while GDAL compresses. If the process is killed, either the old
/// file or the complete new one remains. If heights were missing in the site's terrain file, the
/// metadata state the fraction of its cells that were filled in, 0 to 1 (NAVVY_FILLED_SHARE), and
/// the largest distance to a known cell (NAVVY_FILLED_FROM_M).
/// @throws FileError naming path and cause.
void write_geotiff(const Terrain& terrain, const std::string& path,
                   const std::vector<MapBand>& more = {});

/// Writes `bands` of the whole site `setup` to `path` as a GeoTIFF, in the coordinates of that
/// site.
/// @throws Error if there is no band or a band has the wrong size, FileError if the file cannot be
/// written.
void write_geotiff(const GroundSetup& setup, const std::vector<MapBand>& bands,
                   const std::string& path);

}  // namespace navvy::heightfield
