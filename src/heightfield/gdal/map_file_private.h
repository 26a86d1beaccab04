// SPDX-License-Identifier: Apache-2.0
// An open raster file with its georeference, units and gaps. Shared by the readers of terrain and
// of design surfaces.
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "heightfield/gdal/gdal_session.h"
#include "heightfield/gdal/import.h"
#include "heightfield/raster.h"
#include "heightfield/windowed_raster.h"
#include "scene/ground.h"

namespace navvy::heightfield {

/// An open raster file of heights. Problems that do not prevent its use are noted in `report`.
struct MapFile {
  /// Opens `file` and reads georeference, CRS and units.
  /// @param scale resolution and position for files that have none of their own
  /// @param element name of the scene element in error messages: "terrain" or "design"
  /// @throws InputError naming file, value, rule and remedy.
  MapFile(const std::string& file, const scene::RasterScale& scale, const std::string& element);

  /// Path of the file, and name of its scene element in error messages.
  std::string file, element;
  /// Resolution and position from the scene, for files that have none of their own.
  scene::RasterScale scale;
  /// Array of an NPY file. GDAL has no driver for NPY, so `data` is a dataset on this memory.
  std::vector<char> numbers;
  /// Collects GDAL's error messages. Declared before `data`, because closing the dataset may report
  /// errors.
  GdalSession session;
  /// The open file as a GDAL dataset; null after read_windows moved it out.
  std::unique_ptr<GDALDataset> data;
  /// First band of the file, which contains the heights.
  GDALRasterBand* band = nullptr;
  /// Properties and problems found so far.
  TerrainReport report;
  /// CRS of the file as WKT2; empty if it has none.
  std::string crs_wkt;
  /// True if the file has coordinates of its own.
  bool georeferenced = false;
  /// Lower-left corner of the map (x_min, y_min) and edge lengths of a cell (step_x, step_y), in
  /// file units.
  double x_min = 0, y_min = 0, step_x = 1, step_y = 1;
  /// True if x decreases with the column index (`columns_fall`), and if y decreases with the row
  /// index (`rows_fall`).
  bool columns_fall = false, rows_fall = true;
  /// Size of a storage block of the file, in cells.
  int block_x = 1, block_y = 1;
  /// Size of a decoded storage block [bytes].
  double block_bytes = 0;

  /// Returns a shell command that changes the metadata of the file with the gdal_edit.py option
  /// `option`. Files in other formats than GeoTIFF are converted to GeoTIFF first, because
  /// gdal_edit.py can write only that.
  std::string edit(const std::string& option) const;
  /// Throws an InputError about `part` of the file, with the offending value, the violated rule and
  /// a remedy.
  [[noreturn]] void fail(const std::string& part, const std::string& value, const std::string& rule,
                         const std::string& remedy) const;
};

/// Returns `value` formatted with the printf format `format`, for messages.
std::string number_text(double value, const char* format = "%.10g");

/// Reads the cells under a rectangle of `size` [m], with a margin of two cells, in the orientation
/// of HeightRaster. Gaps are NaN.
///
/// Heights are relative to map.report.height_offset, a whole number of metres near their mean, so
/// that float resolves millimetres. x0 and y0 of the result are relative to `corner`.
/// @param corner lower-left corner of the rectangle, relative to that of the map [m]
/// @throws InputError if all cells are gaps, if there are too many cells, or if the file is
/// damaged.
HeightRaster read_heights(MapFile& map, const Vec2& corner, const Vec2& size);
/// Returns the number of cells that read_heights would read with the same arguments.
std::int64_t cells_under(const MapFile& map, const Vec2& corner, const Vec2& size);
/// Returns the heights of the same cells as read_heights, for a map of any size and with its gaps
/// filled. The file is read completely once, and after that in windows of `side` x `side` cells on
/// demand. Moves the open file out of `map`.
/// @throws InputError as read_heights. Also for a large image file, whose windows would each need
/// decoding from its beginning, and for more gaps than fit in memory.
std::shared_ptr<const WindowedRaster> read_windows(MapFile& map, const Vec2& corner,
                                                   const Vec2& size,
                                                   int side = WindowedRaster::kSide);

}  // namespace navvy::heightfield
