// SPDX-License-Identifier: Apache-2.0
// A raster file opened and understood: its georeference, units and gaps. Shared by the readers of
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

/// One map being read. `report` collects what was found; what is odd about a file is noted there,
/// what cannot be used is thrown with its name.
struct MapFile {
  /// Opens the file and reads georeference, CRS and units. `element` names it in faults: "terrain",
  /// "design".
  /// @throws InputError naming file, value, rule and remedy.
  MapFile(const std::string& file, const scene::RasterScale& scale, const std::string& element);

  std::string file, element;
  scene::RasterScale scale;
  std::vector<char> numbers;  ///< of an NPY, which has no driver: the dataset reads them here
  GdalSession session;        ///< outlives the dataset, whose closing may complain
  std::unique_ptr<GDALDataset> data;
  GDALRasterBand* band = nullptr;
  TerrainReport report;
  std::string crs_wkt;         ///< as WKT2; empty: none
  bool georeferenced = false;  ///< the file tells where it lies
  // Coordinates of the map's lower-left corner and edges of a cell in file units; which way rows
  // and columns run.
  double x_min = 0, y_min = 0, step_x = 1, step_y = 1;
  bool columns_fall = false, rows_fall = true;
  int block_x = 1, block_y = 1;
  double block_bytes = 0;  ///< decoded

  /// The command that changes what the file says of itself: gdal_edit.py can write to GeoTIFF
  /// alone.
  std::string edit(const std::string& option) const;
  [[noreturn]] void fail(const std::string& part, const std::string& value, const std::string& rule,
                         const std::string& remedy) const;
};

/// A number in a message.
std::string number_text(double value, const char* format = "%.10g");

/// Reads the cells under a rectangle of `size` [m] whose lower-left corner lies `corner` [m] from
/// the map's, and two more round it, flipped into our order; gaps are NaN. Heights are counted from
/// `report.height_offset`, a whole number of metres near their mean, so that float keeps
/// millimetres. x0 and y0 count from `corner`.
/// @throws InputError when all of it is a gap, it has too many cells, or the file is damaged.
HeightRaster read_heights(MapFile& map, const Vec2& corner, const Vec2& size);
/// Cells that read_heights would read.
std::int64_t cells_under(const MapFile& map, const Vec2& corner, const Vec2& size);
/// The same heights of a map of any size, gaps filled: read through once, then by windows of `side`
/// cells when they are asked for. Takes the open file out of `map`. @throws InputError likewise,
/// for a picture, and for more gaps than may be held.
std::shared_ptr<const WindowedRaster> read_windows(MapFile& map, const Vec2& corner,
                                                   const Vec2& size,
                                                   int side = WindowedRaster::kSide);

}  // namespace navvy::heightfield
