// SPDX-License-Identifier: Apache-2.0
// Maps come from many sources, so each step names the fault and the remedy, and notes its
// assumptions: open, georeference, CRS, unit of heights. Cells: map_cells.cpp.
#include "heightfield/gdal/map_file_private.h"

#include <cpl_vsi.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "heightfield/gdal/beside.h"
#include "heightfield/npy.h"

namespace navvy::heightfield {
namespace {

// Moves a map of any format to its place.
constexpr const char* kPlaceIt =
    "put it to its place: gdal_translate -a_ullr LEFT TOP RIGHT BOTTOM IN OUT.tif";

/// GDAL has no driver for NPY: the numbers are in memory, and a dataset refers to them.
void open_npy(MapFile& map) {
  NpyGrid grid = read_npy(map.file);
  // In the order of NpyType.
  static constexpr GDALDataType kTypes[] = {GDT_Float32, GDT_Float64, GDT_Int16,
                                            GDT_Int32,   GDT_UInt16,  GDT_Byte};
  const GDALDataType type = kTypes[static_cast<int>(grid.type)];
  map.numbers = std::move(grid.bytes);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  if (driver == nullptr)
    map.fail("", "", "GDAL was built without its memory driver", "install Debian's libgdal");
  map.data.reset(driver->Create("", grid.columns, grid.rows, 0, type, nullptr));
  // GDAL's driver MEM takes the address as text. `numbers` belongs to the map and outlives the
  // dataset.
  char pointer[64] = {};
  CPLPrintPointer(pointer, map.numbers.data(), sizeof pointer - 1);
  const std::string at = std::string("DATAPOINTER=") + pointer;
  const char* options[] = {at.c_str(), nullptr};
  if (!map.data || map.data->AddBand(type, const_cast<char**>(options)) != CE_None)
    map.fail("", "", map.session.cause("cannot be held in memory"), "give a GeoTIFF");
  map.report.format = "NumPy NPY";
  map.report.for_gdal = false;
}

/// Formats that GDAL has a driver for and that we accept.
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
  // Doubles, because the ASCII driver infers integers from the first values.
  const char* const drivers[] = {"GTiff", "AAIGrid", "PNG", nullptr};
  const char* const options[] = {"DATATYPE=Float64", nullptr};
  map.data.reset(GDALDataset::Open(map.file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers,
                                   options, siblings.data()));
  if (!map.data || map.data->GetRasterCount() < 1)
    map.fail("", "", map.session.cause("is neither GeoTIFF, ESRI ASCII, PNG nor NPY"),
             "convert it with gdal_translate -of GTiff");
  map.report.format = map.data->GetDriver()->GetMetadataItem(GDAL_DMD_LONGNAME);
}

bool is_png(const MapFile& map) { return EQUAL(map.data->GetDriver()->GetDescription(), "PNG"); }
bool is_npy(const MapFile& map) { return EQUAL(map.data->GetDriver()->GetDescription(), "MEM"); }

/// Pictures and arrays have neither metres nor coordinates: the scene must give them, and must not
/// for other files.
void check_scale(MapFile& map) {
  const scene::RasterScale& scale = map.scale;
  const bool png = is_png(map), npy = is_npy(map);
  double transform[6];
  if (!png && !npy) {
    if (scale.any())
      map.fail("", map.report.format,
               "map_cell_m, map_heights_m, map_corner_m and map_rows are for PNG and NPY only",
               "remove them: this file gives its own cells and heights");
    return;
  }
  // Two bands are gray and alpha.
  if (png && (map.data->GetRasterCount() > 2 || map.band->GetColorTable() != nullptr))
    map.fail("", std::to_string(map.data->GetRasterCount()) + " bands",
             "heights are gray, this picture has colours", "save it as 16-bit gray");
  if (png && !scale.has_heights)
    map.fail("heights", "", "a picture has no heights of its own",
             "say what black and white stand for: <map_heights_m>0 12.5</map_heights_m>");
  if (npy && scale.has_heights)
    map.fail("heights", "map_heights_m", "an NPY's numbers are metres", "remove map_heights_m");
  if (png && scale.north_first)
    map.fail("", "map_rows", "a picture's first row is north", "remove map_rows");
  if (scale.cell <= 0 && (npy || map.data->GetGeoTransform(transform) != CE_None))
    map.fail("georeference", "", "the file does not give the size of its cells",
             "add e.g. <map_cell_m>0.5</map_cell_m>");
}

// Only the accepted drivers are tried: others reach files elsewhere, or the network.
void open(MapFile& map) {
  map.report.file = map.file;
  // Checked first, because the message of GDAL for a missing file is of no help.
  VSIStatBufL status;
  if (VSIStatL(map.file.c_str(), &status) != 0) map.fail("", "", "no such file", "check the path");
  if (VSI_ISDIR(status.st_mode)) map.fail("", "", "is a directory", "name the map in it");
  if (!VSI_ISREG(status.st_mode)) map.fail("", "", "is not a plain file", "save the map as a file");
  if (is_npy_file(map.file))
    open_npy(map);
  else
    open_raster(map);
  map.band = map.data->GetRasterBand(1);
  if (GDALDataTypeIsComplex(map.band->GetRasterDataType()))
    map.fail("", "", "holds complex numbers", "give a file of heights");
  // From here on it is a map; oddities are noted, not refused.
  map.report.columns = map.data->GetRasterXSize();
  map.report.rows = map.data->GetRasterYSize();
  check_scale(map);
  if (map.data->GetRasterCount() > 1)
    map.report.notes.push_back(std::to_string(map.data->GetRasterCount()) +
                               " bands: the first one is taken as height");
  if (map.band->GetRasterDataType() == GDT_Byte)
    map.report.notes.push_back(
        "8-bit heights: steps of " +
        (map.scale.has_heights
             ? number_text(std::abs(map.scale.high - map.scale.low) / 255, "%.3g") + " m"
             : std::string("a whole unit")) +
        ", and nodata may have become 0");
  int block_x = 0, block_y = 0;
  map.band->GetBlockSize(&block_x, &block_y);
  // A block of pixel-interleaved bands holds all bands.
  const char* interleave = map.data->GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
  const int bands_in_block =
      interleave != nullptr && std::string(interleave) == "PIXEL" ? map.data->GetRasterCount() : 1;
  map.block_x = block_x;
  map.block_y = block_y;
  // 8 bytes are those of the largest type, as complex numbers have been refused.
  map.block_bytes = static_cast<double>(block_x) * block_y * 8 * bands_in_block;
  if (map.block_bytes > limits::kMapBlockBytes)
    // A damaged header may contain any number.
    map.fail("", std::to_string(block_x) + " x " + std::to_string(block_y),
             "is stored in blocks too large to read",
             "rewrite it with gdal_translate -co TILED=YES");
}

// Accepts axes that run backwards and cells that are not square; refuses rotation.
void read_transform(MapFile& map) {
  double g[6];
  const scene::RasterScale& scale = map.scale;
  map.georeferenced = map.data->GetGeoTransform(g) == CE_None && scale.cell <= 0;
  if (!map.georeferenced) {
    const double cell = scale.cell > 0 ? scale.cell : 1;
    const bool north_first = !is_npy(map) || scale.north_first;
    // GDAL's six numbers: x = g0 + g1 column + g2 row, y = g3 + g4 column + g5 row.
    g[0] = scale.corner.x(), g[2] = g[4] = 0, g[1] = cell;
    g[3] = scale.corner.y() + (north_first ? map.report.rows * cell : 0),
    g[5] = north_first ? -cell : cell;
    map.report.notes.push_back(
        "no georeference: cells of " + number_text(cell) + " m, lower-left corner at (" +
        number_text(scale.corner.x()) + ", " + number_text(scale.corner.y()) + ")" +
        (is_npy(map) ? (north_first ? ", first row north" : ", first row south") : ""));
  }
  for (const double value : g)
    if (!std::isfinite(value))
      map.fail("georeference", number_text(value), "must be finite", kPlaceIt);
  if (g[2] != 0 || g[4] != 0)
    map.fail("georeference", number_text(g[2]) + ", " + number_text(g[4]),
             "the map is turned against its coordinate axes", "straighten it: gdalwarp IN OUT.tif");
  if (g[1] == 0 || g[5] == 0) map.fail("georeference", "0", "cells need an extent", kPlaceIt);
  // Either axis may run backwards; we always begin at least x and least y. Row 0 of a usual map is
  // its northern edge.
  map.step_x = std::abs(g[1]);
  map.step_y = std::abs(g[5]);
  map.columns_fall = g[1] < 0;
  map.rows_fall = g[5] < 0;
  map.x_min = std::min(g[0], g[0] + g[1] * map.report.columns);
  map.y_min = std::min(g[3], g[3] + g[5] * map.report.rows);
  map.report.file_min = Vec2(map.x_min, map.y_min);
  map.report.file_max =
      map.report.file_min + Vec2(map.step_x * map.report.columns, map.step_y * map.report.rows);
  // GDAL has already moved the corner of point-registered files by half a cell.
  const char* registration = map.data->GetMetadataItem(GDALMD_AREA_OR_POINT);
  map.report.point_registered = registration != nullptr && EQUAL(registration, GDALMD_AOP_POINT);
}

// Degrees are not lengths: the message describes how to get metres.
void refuse_degrees(MapFile& map) {
  const Vec2 middle = 0.5 * (map.report.file_min + map.report.file_max);
  // Zones of UTM are 6 degrees wide from 180 W on; EPSG numbers them 326xx in the north and 327xx
  // in the south (WGS 84).
  const int zone = std::clamp(static_cast<int>(std::floor((middle.x() + 180) / 6)) + 1, 1, 60);
  const int epsg = (middle.y() < 0 ? 32700 : 32600) + zone;
  map.fail("CRS", map.report.crs, "coordinates are degrees, a site needs lengths",
           "reproject it: gdalwarp -t_srs EPSG:" + std::to_string(epsg) +
               " -r bilinear IN OUT.tif; if they are metres in truth, drop the CRS: " +
               map.edit("-a_srs \"\""));
}

// Finds the unit of the coordinates, which decides all lengths.
void read_crs(MapFile& map) {
  TerrainReport& report = map.report;
  report.unit = report.height_unit = "metre";
  const OGRSpatialReference* declared = map.data->GetSpatialRef();
  // Local engineering grids often come without a CRS: metres are the only sensible assumption then.
  if (declared == nullptr || declared->IsEmpty()) {
    report.notes.push_back("no CRS: coordinates and heights are taken as metres");
  } else {
    report.crs = declared->GetName() != nullptr ? declared->GetName() : "unnamed";
    if (declared->IsGeographic() != 0) {
      // Coordinates of hundreds of kilometres under a CRS of degrees are a wrong label, not a wrong
      // map.
      const Vec2 &low = report.file_min, &high = report.file_max;
      // Both -180 to 180 and 0 to 360 are in use; one degree is left for cells that reach over the
      // border.
      if (low.x() >= -361 && high.x() <= 361 && low.y() >= -91 && high.y() <= 91)
        refuse_degrees(map);
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
  if (!extent.allFinite() || !report.file_min.allFinite() || !(report.cell_x > 0) ||
      !(report.cell_y > 0))
    map.fail("georeference", number_text(map.step_x), "cells must have a finite size", kPlaceIt);
}

// The unit of heights is that of the band, else of a vertical CRS, else the horizontal one.
void read_height_unit(MapFile& map) {
  TerrainReport& report = map.report;
  const std::string unit = map.band->GetUnitType() != nullptr ? map.band->GetUnitType() : "";
  const OGRSpatialReference* declared = map.data->GetSpatialRef();
  // Spellings of GDAL, PROJ, Esri and people.
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
  // EQUAL ignores case, as files write FT, Foot and foot.
  const auto* const known =
      std::find_if(std::begin(kUnits), std::end(kUnits),
                   [&](const Unit& each) { return EQUAL(each.name, unit.c_str()); });
  if (known != std::end(kUnits)) {
    report.height_metres = known->metres;
    if (known->metres != 1) report.height_unit = unit;
  } else if (!unit.empty()) {
    report.notes.push_back(
        "heights in '" + unit +
        "', an unknown unit: taken as metres; to assign one: " + map.edit("-units ft"));
  } else if (declared != nullptr && declared->IsVertical() != 0) {
    const char* name = nullptr;
    report.height_metres = declared->GetTargetLinearUnits("VERT_CS", &name);
    if (name != nullptr) report.height_unit = name;
  } else if (report.metres != 1) {
    report.height_unit = report.unit;
    report.height_metres = report.metres;
    report.notes.push_back("heights carry no unit: taken in the unit of the coordinates (" +
                           report.unit + ")");
  }
  if (!std::isfinite(report.height_metres) || !(report.height_metres > 0))
    map.fail("heights", report.height_unit, "a unit of length must be > 0 m",
             "assign one: " + map.edit("-units m"));
}

}  // namespace

std::string number_text(double value, const char* format) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

void MapFile::fail(const std::string& part, const std::string& value, const std::string& rule,
                   const std::string& remedy) const {
  // Faults of the file itself name the element; parts of a ground have their own names.
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

}  // namespace navvy::heightfield
