// SPDX-License-Identifier: Apache-2.0
// An open raster file of any format: what it declares about itself, and its numbers. Readers of
// formats fill these; map_file.h turns them into a map.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"
#include "heightfield/cell_rect.h"

namespace navvy::heightfield {

/// Size of the cache of decoded blocks [bytes]. GDAL's default is a twentieth of the memory of the
/// machine, but the cost of a map, and whether it is refused, must not depend on that.
inline constexpr std::int64_t kBlockCacheBytes = std::int64_t{512} << 20;

/// Coordinate reference system (CRS) that a file declares.
struct RasterCrs {
  /// False: the file declares none, and the other members have no meaning.
  bool declared = false;
  /// Name of the CRS, and its full text as WKT.
  std::string name, wkt;
  /// True if coordinates are degrees; `unit` and `metres` have no meaning then.
  bool degrees = false;
  /// Name of the unit of the coordinates, and its length [m].
  std::string unit = "metre";
  double metres = 1;
  /// True if the CRS gives the unit of heights, with its name and length [m].
  bool vertical = false;
  std::string height_unit = "metre";
  double height_metres = 1;
};

/// Properties of a raster file as the file declares them.
struct RasterHeader {
  /// Kinds that need different help from the scene or different readers: kGrid and kAsciiGrid (ESRI
  /// ASCII) know their place and their heights, kPicture (PNG) needs the heights of black and
  /// white, and kArray (NPY) holds metres and needs its place.
  enum class Kind { kGrid, kAsciiGrid, kPicture, kArray };
  Kind kind = Kind::kGrid;
  /// Name of the format for reports.
  std::string format;
  /// Number of cells per row, number of rows, and number of values per cell.
  int columns = 0, rows = 0, bands = 1;
  /// True if the values are indices into a table of colours.
  bool has_palette = false;
  /// True if the values are bytes.
  bool has_bytes = false;
  /// The six numbers of a georeference: x = g0 + g1 column + g2 row, y = g3 + g4 column + g5 row,
  /// for the corner of cell (column, row) with the smallest indices.
  std::optional<std::array<double, 6>> place;
  /// True if the file says that heights belong to points.
  bool point_registered = false;
  /// Size of a storage block of the file in cells, and its decoded size [bytes].
  int block_x = 1, block_y = 1;
  double block_bytes = 0;
  /// Value that means "no height"; factor and summand that turn a value into a height.
  std::optional<double> nodata, scale, offset;
  /// Unit of the heights as the file names it; empty if it names none.
  std::string height_unit;
  /// CRS of the coordinates.
  RasterCrs crs;
  /// True if GDAL's command line tools can read the file, and if they can change it in place.
  bool for_gdal = true, editable = false;
};

/// Failure to read a row of a raster file.
class RowError : public FileError {
 public:
  /// Stores the row of the file that cannot be read, from 0, and the cause.
  RowError(int row, const std::string& cause) : FileError(cause), row_(row) {}
  /// Returns the row of the file that cannot be read, from 0.
  int row() const { return row_; }

 private:
  int row_;
};

/// The numbers of an open raster file, in the order of the file. One thread at a time uses it.
class RasterSource {
 public:
  virtual ~RasterSource() = default;
  RasterSource() = default;
  RasterSource(const RasterSource&) = delete;
  RasterSource& operator=(const RasterSource&) = delete;

  /// Prepares the file for reads of these `cells` (x: column, y: row of the file). Must be called
  /// once, before the first read. @throws FileError, RowError or InputError if the file is damaged.
  virtual void prepare(const CellRect& cells) = 0;
  /// Writes the values of `cells`, which must lie within those of `prepare`, to `out`, columns
  /// fastest. @throws FileError or RowError if they cannot be read.
  virtual void read(const CellRect& cells, double* out) = 0;
};

/// Name of a map file, and the places that messages about it name.
struct MapName {
  /// Path of the map file, and name of its scene element in messages: "terrain" or "navvy:design".
  std::string file, element;
  /// Path of the scene file, and line of the element there that names the map; 0 if unknown.
  std::string scene;
  int line = 0;

  /// Throws an InputError about `part` of the file, with the offending value, the violated rule and
  /// a remedy.
  [[noreturn]] void fail(const std::string& part, const std::string& value, const std::string& rule,
                         const std::string& remedy) const;
};

/// A raster file that has been opened.
struct OpenRaster {
  /// Properties of the file.
  RasterHeader header;
  /// Numbers of the file; never null after opening.
  std::unique_ptr<RasterSource> source;
};

}  // namespace navvy::heightfield
