// SPDX-License-Identifier: Apache-2.0
// Reads the files beside a map that give its place, CRS and units: world files, .prj and .aux.xml.
#pragma once

#include <string>

#include "heightfield/map_files/raster_source.h"

namespace navvy::heightfield {

/// Parses a CRS in WKT, as .prj and .aux.xml files hold it: a projected or geographic CRS, and a
/// vertical one with it. Returns a CRS that is not declared for text of another form.
RasterCrs parse_crs(const std::string& wkt);

/// Reads the world file beside a map into `header.place`, if there is one.
/// @throws InputError if it cannot be read, as all functions here.
void read_world_file(const MapName& name, RasterHeader& header);

/// Reads the .prj file beside a map into `header.crs`, if there is one.
void read_projection(const MapName& name, RasterHeader& header);

/// Reads what GDAL's .aux.xml beside a map declares about the first band: unit, scale and offset,
/// and for a picture also georeference, CRS and nodata value. GDAL takes the latter three from an
/// ESRI ASCII grid itself and ignores them here.
void read_auxiliary(const MapName& name, RasterHeader& header);

}  // namespace navvy::heightfield
