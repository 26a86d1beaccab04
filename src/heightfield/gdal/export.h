// SPDX-License-Identifier: Apache-2.0
// Ground as GeoTIFF. Exists only in builds with NAVVY_WITH_GDAL.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// One band of a map that is not a terrain's own.
struct MapBand {
  std::string name, unit;  ///< unit as it is to be told; of heights the file's own takes its place
  /// Fills `out` with rows [y0, y1) of the site, row y0 (least y) first, x fastest; NaN becomes
  /// nodata. Called by one thread at a time, which may be another than the caller's.
  std::function<void(int y0, int y1, std::vector<float>& out)> rows;
  bool height = false;  ///< W z [m]: written in the file's unit and vertical datum
};
/// Writes the present heights of the whole site as float32 GeoTIFF (DEFLATE, PREDICTOR 3, nodata
/// -9999): north up, in the coordinates, units, CRS and vertical datum of the file the site came
/// from, W where it came from none; the unit of heights is the band's, too. Strip by strip, so a
/// large site needs no copy; while strips are packed another thread computes the next. A kill
/// leaves the old file or the new one. Where the site's map had gaps the file's metadata tell the
/// share of its cells that were filled, 0 .. 1 (NAVVY_FILLED_SHARE), and from how far
/// (NAVVY_FILLED_FROM_M). The bands `more` follow that of the heights, their values as they are;
/// readers of heights take the first band.
/// @throws FileError naming path and cause.
void write_geotiff(const Terrain& terrain, const std::string& path,
                   const std::vector<MapBand>& more = {});

/// Same for any dense layer over `rect` of the ground (x fastest, row 0 = least y), values written
/// as they are.
/// @throws Error when sizes do not fit, FileError.
void write_geotiff(const Terrain& terrain, const CellRect& rect, std::span<const float> values,
                   const std::string& path);

/// Bands of a whole site, under their names, in the coordinates that `setup` gives.
/// @throws Error when sizes do not fit or there is no band, FileError.
void write_geotiff(const GroundSetup& setup, const std::vector<MapBand>& bands,
                   const std::string& path);

}  // namespace navvy::heightfield
