// SPDX-License-Identifier: Apache-2.0
// Maps come from everywhere, so each step names what it refuses and how to mend the file, and notes what it had to
// guess: open, georeference, CRS, unit of heights, cells, gaps.
#include "heightfield/gdal/map_file_private.h"

#include <cpl_vsi.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "heightfield/ascii_words.h"
#include "heightfield/gdal/beside.h"
#include "heightfield/npy.h"

namespace navvy::heightfield {
namespace {

// Cells round the site, for interpolation and for filling gaps at its edge.
constexpr int kMargin = 2;
// No ground lies above or below this; such a number is a nodata value that nobody declared [m].
constexpr double kHighest = 12000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Puts a map of whatever format to its place.
constexpr const char* kPlaceIt = "put it to its place: gdal_translate -a_ullr LEFT TOP RIGHT BOTTOM IN OUT.tif";

/// GDAL has no driver for NPY: the numbers lie in memory, and a dataset looks at them there.
void open_npy(MapFile& map) {
  NpyGrid grid = read_npy(map.file);
  static constexpr GDALDataType kTypes[] = {GDT_Float32, GDT_Float64, GDT_Int16, GDT_Int32, GDT_UInt16, GDT_Byte};
  const GDALDataType type = kTypes[static_cast<int>(grid.type)];
  map.numbers = std::move(grid.bytes);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  if (driver == nullptr) map.fail("", "", "GDAL was built without its memory driver", "install Debian's libgdal");
  map.data.reset(driver->Create("", grid.columns, grid.rows, 0, type, nullptr));
  char pointer[64] = {};
  CPLPrintPointer(pointer, map.numbers.data(), sizeof pointer - 1);
  const std::string at = std::string("DATAPOINTER=") + pointer;
  const char* options[] = {at.c_str(), nullptr};
  if (!map.data || map.data->AddBand(type, const_cast<char**>(options)) != CE_None)
    map.fail("", "", map.session.cause("cannot be held in memory"), "give a GeoTIFF");
  map.report.format = "NumPy NPY";
  map.report.for_gdal = false;
}

/// Everything that GDAL has a driver for and we want.
void open_raster(MapFile& map) {
  std::vector<std::string> beside;
  try {
    beside = files_beside(map.file);
  } catch (const FileError& failure) {
    map.fail("", "", failure.what(), "move that file away, or replace it");
  }
  std::vector<const char*> siblings;
  siblings.reserve(beside.size() + 1);
  for (const std::string& name : beside) siblings.push_back(name.c_str());
  siblings.push_back(nullptr);
  // Doubles, because the ASCII driver guesses whole numbers from the first values it sees.
  const char* const drivers[] = {"GTiff", "AAIGrid", "PNG", nullptr};
  const char* const options[] = {"DATATYPE=Float64", nullptr};
  map.data.reset(
      GDALDataset::Open(map.file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, options, siblings.data()));
  if (!map.data || map.data->GetRasterCount() < 1)
    map.fail("", "", map.session.cause("is neither GeoTIFF, ESRI ASCII, PNG nor NPY"),
             "convert it with gdal_translate -of GTiff");
  map.report.format = map.data->GetDriver()->GetMetadataItem(GDAL_DMD_LONGNAME);
}

bool is_png(const MapFile& map) { return EQUAL(map.data->GetDriver()->GetDescription(), "PNG"); }
bool is_npy(const MapFile& map) { return EQUAL(map.data->GetDriver()->GetDescription(), "MEM"); }

/// Pictures and arrays have neither metres nor places: the scene must say them, and of other files it may not.
void check_scale(MapFile& map) {
  const scene::RasterScale& scale = map.scale;
  const bool png = is_png(map), npy = is_npy(map);
  double transform[6];
  if (!png && !npy) {
    if (scale.any())
      map.fail("", map.report.format, "map_cell_m, map_heights_m, map_corner_m and map_rows are for PNG and NPY only",
               "remove them: this file tells its own cells and heights");
    return;
  }
  if (png && (map.data->GetRasterCount() > 2 || map.band->GetColorTable() != nullptr))
    map.fail("", std::to_string(map.data->GetRasterCount()) + " bands", "heights are gray, this picture has colours",
             "save it as 16-bit gray");
  if (png && !scale.has_heights)
    map.fail("heights", "", "a picture has no heights of its own",
             "say what black and white stand for: <map_heights_m>0 12.5</map_heights_m>");
  if (npy && scale.has_heights)
    map.fail("heights", "map_heights_m", "an NPY's numbers are metres", "remove map_heights_m");
  if (png && scale.north_first) map.fail("", "map_rows", "a picture's first row is north", "remove map_rows");
  if (scale.cell <= 0 && (npy || map.data->GetGeoTransform(transform) != CE_None))
    map.fail("georeference", "", "the file does not tell how large its cells are",
             "add e.g. <map_cell_m>0.5</map_cell_m>");
}

void open(MapFile& map) {
  map.report.file = map.file;
  // Asked first, as GDAL's own words for a missing file are of no help.
  VSIStatBufL status;
  if (VSIStatL(map.file.c_str(), &status) != 0) map.fail("", "", "no such file", "check the path");
  if (VSI_ISDIR(status.st_mode)) map.fail("", "", "is a directory", "name the map in it");
  if (!VSI_ISREG(status.st_mode)) map.fail("", "", "is no plain file", "save the map as a file");
  if (is_npy_file(map.file))
    open_npy(map);
  else
    open_raster(map);
  map.band = map.data->GetRasterBand(1);
  if (GDALDataTypeIsComplex(map.band->GetRasterDataType()))
    map.fail("", "", "holds complex numbers", "give a file of heights");
  // From here on it is a map; what is odd about it is noted, not refused.
  map.report.columns = map.data->GetRasterXSize();
  map.report.rows = map.data->GetRasterYSize();
  check_scale(map);
  if (map.data->GetRasterCount() > 1)
    map.report.notes.push_back(std::to_string(map.data->GetRasterCount()) + " bands: the first one is taken as height");
  if (map.band->GetRasterDataType() == GDT_Byte)
    map.report.notes.push_back("8-bit heights: steps of " +
                               (map.scale.has_heights
                                    ? number_text(std::abs(map.scale.high - map.scale.low) / 255, "%.3g") + " m"
                                    : std::string("a whole unit")) +
                               ", and nodata may have become 0");
  int block_x = 0, block_y = 0;
  map.band->GetBlockSize(&block_x, &block_y);
  // A block of pixel-interleaved bands holds them all.
  const char* interleave = map.data->GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
  const int bands_in_block =
      interleave != nullptr && std::string(interleave) == "PIXEL" ? map.data->GetRasterCount() : 1;
  map.block_x = block_x;
  map.block_y = block_y;
  map.block_bytes = static_cast<double>(block_x) * block_y * 8 * bands_in_block;
  if (map.block_bytes > limits::kMapBlockBytes)
    // A damaged header may promise anything.
    map.fail("", std::to_string(block_x) + " x " + std::to_string(block_y), "is stored in blocks too large to read",
             "rewrite it with gdal_translate -co TILED=YES");
}

void read_transform(MapFile& map) {
  double g[6];
  const scene::RasterScale& scale = map.scale;
  map.georeferenced = map.data->GetGeoTransform(g) == CE_None && scale.cell <= 0;
  if (!map.georeferenced) {
    const double cell = scale.cell > 0 ? scale.cell : 1;
    const bool north_first = !is_npy(map) || scale.north_first;
    g[0] = scale.corner.x(), g[2] = g[4] = 0, g[1] = cell;
    g[3] = scale.corner.y() + (north_first ? map.report.rows * cell : 0), g[5] = north_first ? -cell : cell;
    map.report.notes.push_back("no georeference: cells of " + number_text(cell) + " m, lower-left corner at (" +
                               number_text(scale.corner.x()) + ", " + number_text(scale.corner.y()) + ")" +
                               (is_npy(map) ? (north_first ? ", first row north" : ", first row south") : ""));
  }
  for (const double value : g)
    if (!std::isfinite(value)) map.fail("georeference", number_text(value), "must be finite", kPlaceIt);
  if (g[2] != 0 || g[4] != 0)
    map.fail("georeference", number_text(g[2]) + ", " + number_text(g[4]),
             "the map is turned against its coordinate axes", "straighten it: gdalwarp IN OUT.tif");
  if (g[1] == 0 || g[5] == 0) map.fail("georeference", "0", "cells need an extent", kPlaceIt);
  // Either axis may run backwards; we always begin at least x and least y.
  // Row 0 of a usual map is its northern edge.
  map.step_x = std::abs(g[1]);
  map.step_y = std::abs(g[5]);
  map.columns_fall = g[1] < 0;
  map.rows_fall = g[5] < 0;
  map.x_min = std::min(g[0], g[0] + g[1] * map.report.columns);
  map.y_min = std::min(g[3], g[3] + g[5] * map.report.rows);
  map.report.file_min = Vec2(map.x_min, map.y_min);
  map.report.file_max = map.report.file_min + Vec2(map.step_x * map.report.columns, map.step_y * map.report.rows);
  // GDAL has moved the corner of point-registered files by half a cell already.
  const char* registration = map.data->GetMetadataItem(GDALMD_AREA_OR_POINT);
  map.report.point_registered = registration != nullptr && EQUAL(registration, GDALMD_AOP_POINT);
}

// Degrees are no lengths: say how to get metres.
void refuse_degrees(MapFile& map) {
  const Vec2 middle = 0.5 * (map.report.file_min + map.report.file_max);
  const int zone = std::clamp(static_cast<int>(std::floor((middle.x() + 180) / 6)) + 1, 1, 60);
  const int epsg = (middle.y() < 0 ? 32700 : 32600) + zone;
  map.fail("CRS", map.report.crs, "coordinates are degrees, a site needs lengths",
           "reproject it: gdalwarp -t_srs EPSG:" + std::to_string(epsg) +
               " -r bilinear IN OUT.tif; if they are metres in truth, drop the CRS: " + map.edit("-a_srs \"\""));
}

void read_crs(MapFile& map) {
  TerrainReport& report = map.report;
  report.unit = report.height_unit = "metre";
  const OGRSpatialReference* declared = map.data->GetSpatialRef();
  // Engineers' local grids often come without a CRS: metres is then the only sensible guess.
  if (declared == nullptr || declared->IsEmpty()) {
    report.notes.push_back("no CRS: coordinates and heights are taken as metres");
  } else {
    report.crs = declared->GetName() != nullptr ? declared->GetName() : "unnamed";
    if (declared->IsGeographic() != 0) {
      // Coordinates of hundreds of kilometres under a CRS of degrees are a wrong label, not a wrong map.
      const Vec2 &low = report.file_min, &high = report.file_max;
      if (low.x() >= -361 && high.x() <= 361 && low.y() >= -91 && high.y() <= 91) refuse_degrees(map);
      report.notes.push_back("declares degrees (" + report.crs +
                             ") but its coordinates cannot be: taken as metres, CRS dropped");
      report.crs.clear();
    } else {
      const char* name = nullptr;
      report.metres = declared->GetLinearUnits(&name);
      if (name != nullptr) report.unit = name;
      char* wkt = nullptr;
      const char* const format[] = {"FORMAT=WKT2_2019", nullptr};
      if (declared->exportToWkt(&wkt, format) == OGRERR_NONE && wkt != nullptr) map.crs_wkt = wkt;
      CPLFree(wkt);
    }
  }
  if (!std::isfinite(report.metres) || !(report.metres > 0))
    map.fail("CRS", number_text(report.metres), "a unit of length must be > 0 m",
             "assign the right CRS: gdal_translate -a_srs EPSG:CODE IN OUT.tif");
  report.cell_x = map.step_x * report.metres;
  report.cell_y = map.step_y * report.metres;
  const Vec2 extent = (report.file_max - report.file_min) * report.metres;
  if (!extent.allFinite() || !report.file_min.allFinite() || !(report.cell_x > 0) || !(report.cell_y > 0))
    map.fail("georeference", number_text(map.step_x), "cells must have a finite size", kPlaceIt);
}

// The unit of heights: the band's, else that of a vertical CRS, else the horizontal one.
void read_height_unit(MapFile& map) {
  TerrainReport& report = map.report;
  const std::string unit = map.band->GetUnitType() != nullptr ? map.band->GetUnitType() : "";
  const OGRSpatialReference* declared = map.data->GetSpatialRef();
  // As GDAL, PROJ, Esri and people write them.
  struct Unit {
    const char* name;
    double metres;
  };
  static constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;
  static constexpr Unit kUnits[] = {{"m", 1},
                                    {"metre", 1},
                                    {"meter", 1},
                                    {"metres", 1},
                                    {"meters", 1},
                                    {"ft", kFoot},
                                    {"foot", kFoot},
                                    {"feet", kFoot},
                                    {"international foot", kFoot},
                                    {"US survey foot", kSurveyFoot},
                                    {"US survey feet", kSurveyFoot},
                                    {"Foot_US", kSurveyFoot},
                                    {"ftUS", kSurveyFoot},
                                    {"us-ft", kSurveyFoot}};
  const auto* const known = std::find_if(std::begin(kUnits), std::end(kUnits),
                                         [&](const Unit& each) { return EQUAL(each.name, unit.c_str()); });
  if (known != std::end(kUnits)) {
    report.height_metres = known->metres;
    if (known->metres != 1) report.height_unit = unit;
  } else if (!unit.empty()) {
    report.notes.push_back("heights in '" + unit +
                           "', which is no known unit: taken as metres; to assign one: " + map.edit("-units ft"));
  } else if (declared != nullptr && declared->IsVertical() != 0) {
    const char* name = nullptr;
    report.height_metres = declared->GetTargetLinearUnits("VERT_CS", &name);
    if (name != nullptr) report.height_unit = name;
  } else if (report.metres != 1) {
    report.height_unit = report.unit;
    report.height_metres = report.metres;
    report.notes.push_back("heights carry no unit: taken in the unit of the coordinates (" + report.unit + ")");
  }
  if (!std::isfinite(report.height_metres) || !(report.height_metres > 0))
    map.fail("heights", report.height_unit, "a unit of length must be > 0 m", "assign one: " + map.edit("-units m"));
}

/// Heights that are whole numbers of a unit only: a staircase, unless they are all one.
class Staircase {
 public:
  explicit Staircase(double unit) : unit_(unit) {}
  void look(double height) {
    const double steps = height / unit_;
    // A float of a whole metre in feet is off by less.
    whole_ = whole_ && std::abs(steps - std::round(steps)) < 1e-4;
    least_ = std::min(least_, height);
    most_ = std::max(most_, height);
  }
  bool found() const { return whole_ && most_ - least_ > 0.5 * unit_; }

 private:
  double unit_, least_ = kHighest, most_ = -kHighest;
  bool whole_ = true;
};

void note_staircase(MapFile& map, const std::string& unit, double metres) {
  TerrainReport& report = map.report;
  // Means of some cells lie between two steps, and what is bilinear between them has the slopes of the ground.
  const double wide = 4 * std::max(map.step_x, map.step_y);
  report.notes.push_back("all heights are whole numbers of the " + unit + ": a staircase with steps of " +
                         number_text(metres, "%.4g") + " m; get them with decimals, or smooth them: " +
                         (report.for_gdal ? "gdalwarp -ot Float32 -r average -tr " + number_text(wide) + " " +
                                                number_text(wide) + " IN OUT.tif"
                                          : "scipy.ndimage.uniform_filter before numpy.save"));
}

// Turns what a file says into metres, and every spelling of "no data" into NaN.
class Decoder {
 public:
  explicit Decoder(MapFile& map) {
    int has = 0;
    const double value = map.band->GetNoDataValue(&has);
    if (has != 0) nodata_ = static_cast<float>(value);
    has_nodata_ = has != 0;
    map.report.nodata_value = has != 0 ? "declared as " + number_text(value) : "none declared";
    // GDAL does not apply scale and offset itself.
    const double scale = map.band->GetScale(&has);
    if (has != 0 && std::isfinite(scale) && scale != 0) scale_ = scale;
    const double offset = map.band->GetOffset(&has);
    if (has != 0 && std::isfinite(offset)) offset_ = offset;
    // Black and white of a picture.
    if (map.scale.has_heights) {
      offset_ = map.scale.low;
      scale_ = (map.scale.high - map.scale.low) / (map.band->GetRasterDataType() == GDT_Byte ? 255 : 65535);
    }
    metres_ = map.report.height_metres;
  }
  double operator()(double raw) const {
    if (is_nodata(raw)) return kNaN;
    // What no ground can be is nodata that nobody declared.
    const double height = (raw * scale_ + offset_) * metres_;
    return std::abs(height) <= kHighest ? height : kNaN;
  }
  /// As the file declares it, or as many write it without.
  bool is_nodata(double raw) const {
    // Compared in float32: a double that went through a float file is no longer equal.
    const auto single = static_cast<float>(raw);
    if (std::isnan(single) || (has_nodata_ && single == nodata_)) return true;
    const double usual[] = {-9999.0, -9999.005859375, -32768.0, -32767.0};
    return std::find(std::begin(usual), std::end(usual), raw) != std::end(usual);
  }

 private:
  bool has_nodata_ = false;
  float nodata_ = 0;
  double scale_ = 1, offset_ = 0, metres_ = 1;
};

/// Reads an ESRI ASCII map in the order of its rows up to the last one needed. GDAL finds the start of a row by reading
/// those before it and goes on after a row that fails: asked for the last row of a cut file it tries 2^rows times.
void find_rows(MapFile& map, int last_row) {
  if (std::string(map.data->GetDriver()->GetDescription()) != "AAIGrid") return;
  check_words(map.file, (static_cast<std::int64_t>(last_row) + 1) * map.report.columns);
  for (int row = 0; row <= last_row; ++row) {
    double value = 0;
    if (map.band->RasterIO(GF_Read, 0, row, 1, 1, &value, 1, 1, GDT_Float64, 0, 0, nullptr) != CE_None)
      map.fail("row " + std::to_string(row), "", map.session.cause("cannot be read"),
               "the file is damaged: get it again");
  }
}

/// A few bytes may decode to gigabytes, and blocks that do not fit into GDAL's cache side by side are decoded for every
/// row anew.
void check_blocks(const MapFile& map, int x0, int x1, int y0, int y1) {
  const int blocks_x = x1 / map.block_x - x0 / map.block_x + 1, blocks_y = y1 / map.block_y - y0 / map.block_y + 2;
  const double across = blocks_x, down = blocks_y;
  const bool kept = across * map.block_bytes <= static_cast<double>(GDALGetCacheMax64());
  const double decoded = across * (kept ? down : y1 - y0 + 1.0) * map.block_bytes;
  if (decoded > limits::kMapDecodedBytes)
    map.fail("", number_text(decoded) + " bytes",
             "more than " + number_text(limits::kMapDecodedBytes) +
                 " to decode for this site: its blocks hold far more than the site",
             "rewrite it with gdal_translate -co TILED=YES");
}

}  // namespace

std::string number_text(double value, const char* format) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

void MapFile::fail(const std::string& part, const std::string& value, const std::string& rule,
                   const std::string& remedy) const {
  // What is wrong with the file as such is told of the element; a ground's parts go by their own names.
  const bool of_ground = element == "terrain" && part != "at" && part != "size";
  const std::string where = part.empty() ? element : of_ground ? part : element + "/" + part;
  throw InputError(Fault{Fault::Severity::kError, file, 0, where, value, rule, remedy});
}

std::string MapFile::edit(const std::string& option) const {
  if (EQUAL(data->GetDriver()->GetDescription(), "GTiff")) return "gdal_edit.py " + option + " IN";
  return "gdal_translate IN OUT.tif, then gdal_edit.py " + option + " OUT.tif";
}

MapFile::MapFile(const std::string& path, const scene::RasterScale& how, const std::string& what)
    : file(path), element(what), scale(how) {
  open(*this);
  read_transform(*this);
  read_crs(*this);
  read_height_unit(*this);
}

namespace {

/// Which of a file's cells are read, and how they are turned into our order.
struct Cut {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< of the map's cells in our order, the last ones inclusive
  int columns = 0, rows = 0;           ///< of the whole file
  bool columns_fall = false, rows_fall = true;
};

/// Cells that the site needs, with a margin; clamped in double, as a damaged header may give any number.
Cut cut_of(const MapFile& map, const Vec2& corner, const Vec2& size) {
  const TerrainReport& report = map.report;
  const auto first = [](double x, double cell, int n) {
    return static_cast<int>(std::clamp(std::floor(x / cell) - kMargin, 0.0, n - 1.0));
  };
  const auto last = [](double x, double cell, int n) {
    return static_cast<int>(std::clamp(std::floor(x / cell) + kMargin, 0.0, n - 1.0));
  };
  return {first(corner.x(), report.cell_x, report.columns),
          first(corner.y(), report.cell_y, report.rows),
          last(corner.x() + size.x(), report.cell_x, report.columns),
          last(corner.y() + size.y(), report.cell_y, report.rows),
          report.columns,
          report.rows,
          map.columns_fall,
          map.rows_fall};
}

/// The raster of a cut without its heights.
HeightRaster frame_of(const TerrainReport& report, const Cut& cut, const Vec2& corner) {
  HeightRaster raster;
  raster.nx = cut.x1 - cut.x0 + 1;
  raster.ny = cut.y1 - cut.y0 + 1;
  raster.cell_x = report.cell_x;
  raster.cell_y = report.cell_y;
  raster.x0 = (cut.x0 + 0.5) * report.cell_x - corner.x();
  raster.y0 = (cut.y0 + 0.5) * report.cell_y - corner.y();
  return raster;
}

/// Raw numbers of some cells of the cut, counted from its first, x fastest. False where the file cannot be read.
bool read_raw(GDALRasterBand& band, const Cut& cut, const CellRect& cells, std::vector<double>& raw) {
  const int nx = cells.x1 - cells.x0, ny = cells.y1 - cells.y0;
  const int column = cut.columns_fall ? cut.columns - (cut.x0 + cells.x1) : cut.x0 + cells.x0;
  const int row = cut.rows_fall ? cut.rows - (cut.y0 + cells.y1) : cut.y0 + cells.y0;
  raw.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  if (band.RasterIO(GF_Read, column, row, nx, ny, raw.data(), nx, ny, GDT_Float64, 0, 0, nullptr) != CE_None)
    return false;
  const auto line = [&](int y) { return raw.begin() + static_cast<std::ptrdiff_t>(y) * nx; };
  for (int y = 0; cut.columns_fall && y < ny; ++y) std::reverse(line(y), line(y + 1));
  for (int y = 0; cut.rows_fall && y < ny / 2; ++y) std::swap_ranges(line(y), line(y + 1), line(ny - 1 - y));
  return true;
}

/// Heights as they come out of the file: counts them, takes their mean, notes what is odd.
class Intake {
 public:
  Intake(MapFile& map) : map_(map), decode_(map), in_units_(map.report.height_metres), in_metres_(1) {}
  const Decoder& decoder() const { return decode_; }
  /// Above `first()`, as it is known so far; NaN for a gap.
  float take(double raw) {
    TerrainReport& report = map_.report;
    const double height = decode_(raw);
    if (std::isnan(height) && !decode_.is_nodata(raw) && report.unmarked++ == 0) report.unmarked_value = raw;
    // The first height found stands in for the offset until the mean is known.
    if (!std::isnan(height) && known_++ == 0) first_ = std::floor(height);
    if (!std::isnan(height)) {
      sum_ += height - first_;
      in_units_.look(height);
      in_metres_.look(height);
    }
    return static_cast<float>(height - first_);
  }
  double first() const { return first_; }
  /// A whole number of metres near the mean of what `take` gave, exact in float. @throws InputError without a height.
  /// Tells of a staircase.
  double shift() const {
    if (known_ == 0)
      map_.fail("at", "", "there is no height anywhere under the site, all is nodata",
                "move the site to where the map has data");
    if (in_metres_.found())
      note_staircase(map_, "metre", 1);
    else if (in_units_.found())
      note_staircase(map_, map_.report.height_unit, map_.report.height_metres);
    return std::floor(sum_ / static_cast<double>(known_));
  }

 private:
  MapFile& map_;
  Decoder decode_;
  Staircase in_units_, in_metres_;  ///< the latter also of metres that somebody turned into feet
  double first_ = 0, sum_ = 0;
  std::int64_t known_ = 0;
};

/// Map cells that lie on the site, in part at least, and how many of them have no height.
class SiteCells {
 public:
  SiteCells(const HeightRaster& frame, const Vec2& size, TerrainReport& report)
      : x_(range(frame.x0, frame.cell_x, size.x(), frame.nx)),
        y_(range(frame.y0, frame.cell_y, size.y(), frame.ny)),
        report_(report) {
    report.site_cells = static_cast<std::int64_t>(x_.second - x_.first) * (y_.second - y_.first);
  }
  /// The cell has no height.
  void gap(int ix, int iy) {
    if (ix >= x_.first && ix < x_.second && iy >= y_.first && iy < y_.second) ++report_.site_gaps;
  }

 private:
  /// First cell along an axis that touches [0, length], and the one after the last.
  static std::pair<int, int> range(double first, double cell, double length, int count) {
    const auto touches = [&](int i) {
      const double centre = first + i * cell;
      return centre + (0.5 - 1e-6) * cell > 0 && centre - (0.5 - 1e-6) * cell < length;
    };
    int begin = 0, end = count;
    while (begin < end && !touches(begin)) ++begin;
    while (end > begin && !touches(end - 1)) --end;
    return {begin, end};
  }
  std::pair<int, int> x_, y_;
  TerrainReport& report_;
};

[[noreturn]] void fail_row(const MapFile& map, int row) {
  map.fail("row " + std::to_string(row), "", map.session.cause("cannot be read"), "the file is damaged: get it again");
}

/// A map that stays open: its cells as heights, whenever they are asked for.
class OpenMap {
 public:
  /// Takes the file over.
  OpenMap(MapFile& map, const Cut& cut, const Decoder& decode, double first, double shift)
      : file_(map.file),
        element_(map.element),
        numbers_(std::move(map.numbers)),
        data_(std::move(map.data)),
        band_(map.band),
        cut_(cut),
        decode_(decode),
        first_(first),
        shift_(shift) {
    map.band = nullptr;
  }
  ~OpenMap() {
    // Closing may complain.
    const GdalSession session;
    data_.reset();
  }
  OpenMap(const OpenMap&) = delete;
  OpenMap& operator=(const OpenMap&) = delete;

  /// As read_heights makes them. @throws InputError.
  void read(const CellRect& cells, float* out) {
    const GdalSession session;
    if (!read_raw(*band_, cut_, cells, raw_))
      throw InputError(Fault{Fault::Severity::kError, file_, 0, element_, "", session.cause("cannot be read"),
                             "the file is damaged or gone: get it again"});
    // Rounded to float before and after the shift, as a map that is held is.
    std::transform(raw_.begin(), raw_.end(), out,
                   [&](double raw) { return static_cast<float>(static_cast<float>(decode_(raw) - first_) - shift_); });
  }

 private:
  std::string file_, element_;
  std::vector<char> numbers_;
  std::unique_ptr<GDALDataset> data_;
  GDALRasterBand* band_;
  Cut cut_;
  Decoder decode_;
  double first_, shift_;
  std::vector<double> raw_;
};

}  // namespace

std::int64_t cells_under(const MapFile& map, const Vec2& corner, const Vec2& size) {
  const Cut cut = cut_of(map, corner, size);
  return static_cast<std::int64_t>(cut.x1 - cut.x0 + 1) * (cut.y1 - cut.y0 + 1);
}

HeightRaster read_heights(MapFile& map, const Vec2& corner, const Vec2& size) {
  TerrainReport& report = map.report;
  const Cut cut = cut_of(map, corner, size);
  HeightRaster raster = frame_of(report, cut, corner);
  report.source_cells = static_cast<std::int64_t>(raster.nx) * raster.ny;
  // Before memory is asked for.
  if (static_cast<double>(report.source_cells) > limits::kMapCells)
    map.fail("size", std::to_string(raster.nx) + " x " + std::to_string(raster.ny) + " map cells",
             "more than " + number_text(limits::kMapCells) + " cells under the site",
             "choose a smaller --size or a coarser map");
  check_blocks(map, cut.x0, cut.x1, cut.y0, cut.y1);
  raster.z.resize(static_cast<std::size_t>(report.source_cells));
  Intake intake(map);
  SiteCells on_site(raster, size, report);
  std::vector<double> line;
  find_rows(map, map.rows_fall ? report.rows - 1 - cut.y0 : cut.y1);
  for (int iy = 0; iy < raster.ny; ++iy) {
    if (!read_raw(*map.band, cut, {0, iy, raster.nx, iy + 1}, line))
      fail_row(map, map.rows_fall ? report.rows - 1 - (cut.y0 + iy) : cut.y0 + iy);
    for (int ix = 0; ix < raster.nx; ++ix)
      if (std::isnan(raster.at(ix, iy) = intake.take(line[static_cast<std::size_t>(ix)]))) on_site.gap(ix, iy);
  }
  const double shift = intake.shift();
  for (float& z : raster.z) z = static_cast<float>(z - shift);
  report.height_offset = intake.first() + shift;
  return raster;
}

std::shared_ptr<const WindowedRaster> read_windows(MapFile& map, const Vec2& corner, const Vec2& size, int side) {
  TerrainReport& report = map.report;
  const Cut cut = cut_of(map, corner, size);
  const HeightRaster frame = frame_of(report, cut, corner);
  report.source_cells = static_cast<std::int64_t>(frame.nx) * frame.ny;
  // A picture is decoded from its beginning for every window.
  if (is_png(map))
    map.fail("size", std::to_string(frame.nx) + " x " + std::to_string(frame.ny) + " map cells",
             "more than " + number_text(limits::kMapCells) + " cells of a picture under the site",
             "convert it with gdal_translate -of GTiff -co TILED=YES");
  check_blocks(map, cut.x0, cut.x1, cut.y0, cut.y1);
  find_rows(map, map.rows_fall ? report.rows - 1 - cut.y0 : cut.y1);
  // One pass for the mean and the gaps; what it decodes is read again when it is needed.
  Intake intake(map);
  SiteCells on_site(frame, size, report);
  std::vector<std::int64_t> gaps;
  std::vector<double> raw;
  for (int y0 = 0; y0 < frame.ny; y0 += side) {
    const CellRect strip{0, y0, frame.nx, std::min(y0 + side, frame.ny)};
    if (!read_raw(*map.band, cut, strip, raw))
      fail_row(map, map.rows_fall ? report.rows - (cut.y0 + strip.y1) : cut.y0 + strip.y0);
    const std::int64_t begin = static_cast<std::int64_t>(y0) * frame.nx;
    for (std::size_t i = 0; i < raw.size(); ++i)
      if (std::isnan(intake.take(raw[i]))) {
        gaps.push_back(begin + static_cast<std::int64_t>(i));
        on_site.gap(static_cast<int>(i) % frame.nx, y0 + static_cast<int>(i) / frame.nx);
      }
    if (static_cast<double>(gaps.size()) > limits::kMapCells)
      map.fail("nodata", std::to_string(gaps.size()) + " cells",
               "more than " + number_text(limits::kMapCells) + " cells without a height under the site",
               "choose a smaller --size, or fill them with gdal_fillnodata.py");
  }
  const double shift = intake.shift();
  report.height_offset = intake.first() + shift;
  const auto open_map = std::make_shared<OpenMap>(map, cut, intake.decoder(), intake.first(), shift);
  const auto out = std::make_shared<WindowedRaster>(
      frame, [open_map](const CellRect& cells, float* to) { open_map->read(cells, to); }, side);
  report.nodata = out->fill_gaps(std::move(gaps));
  return out;
}

}  // namespace navvy::heightfield
