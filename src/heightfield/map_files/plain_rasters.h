// SPDX-License-Identifier: Apache-2.0
// Readers of map files that need no GDAL: NPY, ESRI ASCII grids and, unless NAVVY_CORE_ONLY, PNG.
// Every build reads the numbers of these with them. GDAL, where it is there, only says what a file
// and those beside it declare: it knows all coordinate systems, but finds each row of a PNG anew
// from the beginning if the last rows are read first.
#pragma once

#include "heightfield/map_files/raster_source.h"

namespace navvy::heightfield {

/// Opens an NPY file, which is held in memory. @throws InputError as read_npy.
OpenRaster open_npy(const MapName& name);

/// Returns true if the file begins with a key of an ESRI ASCII header.
bool is_ascii_grid(const std::string& path);
/// Returns the numbers of an ESRI ASCII grid. Rows are parsed when they are read.
std::unique_ptr<RasterSource> ascii_numbers(const MapName& name, int columns);
/// Opens an ESRI ASCII grid, with the files beside it.
/// @throws InputError for a header without a size, or a file beside it that cannot be read.
OpenRaster open_ascii_grid(const MapName& name);

/// Returns true if the file begins with the PNG signature.
bool is_png_file(const std::string& path);
/// Returns the gray values of a PNG file. The picture is decoded once, and the cells that are
/// wanted are held, two bytes each.
std::unique_ptr<RasterSource> png_numbers(const MapName& name);
/// Opens a PNG file, with the files beside it. @throws InputError for a damaged header, or a file
/// beside it that cannot be read.
OpenRaster open_png(const MapName& name);

/// Opens a file in one of these formats. @throws InputError as the above; for any other format it
/// names the line of the scene, and says how to convert the map.
OpenRaster open_plain(const MapName& name);

}  // namespace navvy::heightfield
