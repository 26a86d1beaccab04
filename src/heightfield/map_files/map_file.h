// SPDX-License-Identifier: Apache-2.0
// An open map with its georeference, units and gaps. Shared by the readers of terrain and of design
// surfaces.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "heightfield/map_files/import.h"
#include "heightfield/map_files/raster_source.h"
#include "heightfield/raster.h"
#include "heightfield/windowed_raster.h"
#include "scene/ground.h"

namespace navvy::heightfield {

/// An open raster file of heights. Problems that do not prevent its use are noted in `report`.
struct MapFile {
  /// Opens a file and reads georeference, CRS and units.
  /// @param how_scaled resolution and position for files that have none of their own
  /// @throws InputError naming file, value, rule and remedy.
  MapFile(const MapName& map, const scene::RasterScale& how_scaled,
          MapReader reader = MapReader::kBuild);

  /// File, and the places that messages name.
  MapName name;
  /// Resolution and position from the scene, for files that have none of their own.
  scene::RasterScale scale;
  /// Properties that the file declares.
  RasterHeader header;
  /// Numbers of the file; null after read_windows moved it out.
  std::unique_ptr<RasterSource> source;
  /// Properties and problems found so far.
  TerrainReport report;
  /// CRS of the file as WKT, WKT2 from GDAL; empty if it has none.
  std::string crs_wkt;
  /// Lower-left corner of the map (x_min, y_min) and edge lengths of a cell (step_x, step_y), in
  /// file units.
  double x_min = 0, y_min = 0, step_x = 1, step_y = 1;
  /// True if x decreases with the column index (`columns_fall`), and if y decreases with the row
  /// index (`rows_fall`).
  bool columns_fall = false, rows_fall = true;

  /// Returns a shell command that changes the metadata of the file with the gdal_edit.py option
  /// `option`. Files in other formats than GeoTIFF are converted to GeoTIFF first, because
  /// gdal_edit.py can write only that.
  std::string edit(const std::string& option) const;
  /// Throws as MapName::fail.
  [[noreturn]] void fail(const std::string& part, const std::string& value, const std::string& rule,
                         const std::string& remedy) const {
    name.fail(part, value, rule, remedy);
  }
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
/// demand. Moves the numbers out of `map`.
/// @throws InputError as read_heights. Also for a large image file, whose windows would each need
/// decoding from its beginning, and for more gaps than fit in memory.
std::shared_ptr<const WindowedRaster> read_windows(MapFile& map, const Vec2& corner,
                                                   const Vec2& size,
                                                   int side = WindowedRaster::kSide);

}  // namespace navvy::heightfield
