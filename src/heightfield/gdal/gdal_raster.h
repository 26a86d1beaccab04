// SPDX-License-Identifier: Apache-2.0
// Opens raster files through GDAL. Only in builds with NAVVY_WITH_GDAL.
#pragma once

#include <string>

#include "heightfield/map_files/raster_source.h"

namespace navvy::heightfield {

/// Opens a GeoTIFF, ESRI ASCII grid or PNG.
/// @throws InputError naming the file if it is in another format, or GDAL cannot open it.
OpenRaster open_with_gdal(const MapName& name);

/// Returns true if the horizontal parts of two CRS, given as WKT, are equal.
bool same_crs(const std::string& a, const std::string& b);

}  // namespace navvy::heightfield
