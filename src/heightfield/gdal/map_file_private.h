// SPDX-License-Identifier: Apache-2.0
// A raster file that is open, with its georeference, units and gaps. Shared by the readers of
// ground and design.
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

/// A map that is being read. Oddities of the file are noted in `report`; a file that cannot be used
/// is refused by name.
struct MapFile {
  /// Opens the file and reads georeference, CRS and units. `element` names it in faults: "terrain"
  /// or "design".
  /// @throws InputError naming file, value, rule and remedy.
  MapFile(const std::string& file, const scene::RasterScale& scale, const std::string& element);

  /// Path of the file, and its name in faults.
  std::string file, element;
  /// Metres and place from the scene, for files that have none.
  scene::RasterScale scale;
  /// Values of an NPY file, which GDAL has no driver for: the dataset reads them from here.
  std::vector<char> numbers;
  /// Outlives the dataset, whose closing may report failures.
  GdalSession session;
  /// The open file.
  std::unique_ptr<GDALDataset> data;
  /// Its first band, which holds the heights.
  GDALRasterBand* band = nullptr;
  /// Findings so far.
  TerrainReport report;
  /// CRS as WKT2; empty where the file has none.
  std::string crs_wkt;
  /// True when the file gives its own coordinates.
  bool georeferenced = false;
  /// Lower-left corner of the map and edges of a cell in file units, and the direction in which
  /// rows and columns run.
  double x_min = 0, y_min = 0, step_x = 1, step_y = 1;
  /// True where columns run towards least x, or rows towards least y.
  bool columns_fall = false, rows_fall = true;
  /// Size of a block of the file in cells.
  int block_x = 1, block_y = 1;
  /// Size of a decoded block.
  double block_bytes = 0;

  /// Returns the command that changes the file's own description; gdal_edit.py can write to GeoTIFF
  /// only.
  std::string edit(const std::string& option) const;
  /// Throws an InputError about a part of the file.
  [[noreturn]] void fail(const std::string& part, const std::string& value, const std::string& rule,
                         const std::string& remedy) const;
};

/// Formats a number for a message.
std::string number_text(double value, const char* format = "%.10g");

/// Reads the cells under a rectangle of `size` [m], and two more around it, in our order; gaps are
/// NaN. `corner` [m] is the lower-left corner of the rectangle, counted from that of the map.
/// Heights are counted from `report.height_offset`, a whole number of metres near their mean, so
/// that float resolves millimetres. x0 and y0 of the raster count from `corner`.
/// @throws InputError when all of it is a gap, it has too many cells, or the file is damaged.
HeightRaster read_heights(MapFile& map, const Vec2& corner, const Vec2& size);
/// Returns the number of cells that read_heights would read.
std::int64_t cells_under(const MapFile& map, const Vec2& corner, const Vec2& size);
/// Returns the same heights for a map of any size, with gaps filled: the file is read through once,
/// and then in windows of `side` cells on demand. Takes the open file out of `map`.
/// @throws InputError as read_heights, for a picture, and for more gaps than can be held.
std::shared_ptr<const WindowedRaster> read_windows(MapFile& map, const Vec2& corner,
                                                   const Vec2& size,
                                                   int side = WindowedRaster::kSide);

}  // namespace navvy::heightfield
