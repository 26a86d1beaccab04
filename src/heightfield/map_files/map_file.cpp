// SPDX-License-Identifier: Apache-2.0
// Maps come from many sources, so each step names the fault and the remedy, and notes its
// assumptions: open, georeference, CRS, unit of heights. Cells: map_cells.cpp.
#include "heightfield/map_files/map_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/error.h"
#include "core/limits.h"
#include "heightfield/map_files/ascii_words.h"
#include "heightfield/map_files/npy.h"
#include "heightfield/map_files/plain_rasters.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/gdal_raster.h"
#endif

namespace navvy::heightfield {
namespace {

using Kind = RasterHeader::Kind;

// Moves a map of any format to its place.
constexpr const char* kPlaceIt =
    "put it to its place: gdal_translate -a_ullr LEFT TOP RIGHT BOTTOM IN OUT.tif";

/// Pictures and arrays have neither metres nor coordinates: the scene must give them, and must not
/// for other files.
void check_scale(MapFile& map) {
  const scene::RasterScale& scale = map.scale;
  const bool png = map.header.kind == Kind::kPicture, npy = map.header.kind == Kind::kArray;
  if (!png && !npy) {
    if (scale.any())
      map.fail("", map.report.format,
               "map_cell_m, map_heights_m, map_corner_m and map_rows are for PNG and NPY only",
               "remove them: this file gives its own cells and heights");
    return;
  }
  // Two bands are gray and alpha.
  if (png && (map.header.bands > 2 || map.header.has_palette))
    map.fail("", std::to_string(map.header.bands) + " bands",
             "heights are gray, this picture has colours", "save it as 16-bit gray");
  if (png && !scale.has_heights)
    map.fail("heights", "", "a picture has no heights of its own",
             "say what black and white stand for: <map_heights_m>0 12.5</map_heights_m>");
  if (npy && scale.has_heights)
    map.fail("heights", "map_heights_m", "an NPY's numbers are metres", "remove map_heights_m");
  if (png && scale.north_first)
    map.fail("", "map_rows", "a picture's first row is north", "remove map_rows");
  if (scale.cell <= 0 && !map.header.place)
    map.fail("georeference", "", "the file does not give the size of its cells",
             "add e.g. <map_cell_m>0.5</map_cell_m>");
}

OpenRaster open_raster(const MapName& name, MapReader reader) {
  if (reader == MapReader::kPlain) return open_plain(name);
  // Every build reads these arrays itself.
  if (is_npy_file(name.file)) return open_npy(name);
#ifdef NAVVY_WITH_GDAL
  OpenRaster raster = open_with_gdal(name);
  if (reader == MapReader::kGdal) return raster;
  if (raster.header.kind == Kind::kPicture) raster.source = png_numbers(name);
  if (raster.header.kind == Kind::kAsciiGrid)
    raster.source = ascii_numbers(name, raster.header.columns);
  return raster;
#else
  return open_plain(name);
#endif
}

/// Checks that there is a file that may be opened: a pipe would wait for its writer.
void check_file(const MapName& name) {
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(name.file, failed);
  if (!std::filesystem::exists(status)) name.fail("", "", "no such file", "check the path");
  if (std::filesystem::is_directory(status))
    name.fail("", "", "is a directory", "name the map in it");
  if (!std::filesystem::is_regular_file(status))
    name.fail("", "", "is not a plain file", "save the map as a file");
}

// From here on it is a map; oddities are noted, not refused.
void open(MapFile& map, MapReader reader) {
  check_file(map.name);
  OpenRaster raster = open_raster(map.name, reader);
  map.header = std::move(raster.header);
  map.source = std::move(raster.source);
  const RasterHeader& header = map.header;
  map.report.file = map.name.file;
  map.report.format = header.format;
  map.report.for_gdal = header.for_gdal;
  map.report.columns = header.columns;
  map.report.rows = header.rows;
  map.report.point_registered = header.point_registered;
  check_scale(map);
  if (header.bands > 1)
    map.report.notes.push_back(std::to_string(header.bands) +
                               " bands: the first one is taken as height");
  if (header.has_bytes)
    map.report.notes.push_back(
        "8-bit heights: steps of " +
        (map.scale.has_heights
             ? number_text(std::abs(map.scale.high - map.scale.low) / 255, "%.3g") + " m"
             : std::string("a whole unit")) +
        ", and nodata may have become 0");
  if (header.block_bytes > limits::kMapBlockBytes)
    // A damaged header may contain any number.
    map.fail("", std::to_string(header.block_x) + " x " + std::to_string(header.block_y),
             "is stored in blocks too large to read",
             "rewrite it with gdal_translate -co TILED=YES");
}

// Accepts axes that run backwards and cells that are not square; refuses rotation.
void read_transform(MapFile& map) {
  const scene::RasterScale& scale = map.scale;
  std::array<double, 6> g = {};
  if (map.header.place && scale.cell <= 0) {
    g = *map.header.place;
  } else {
    const double cell = scale.cell > 0 ? scale.cell : 1;
    const bool npy = map.header.kind == Kind::kArray, north_first = !npy || scale.north_first;
    g[0] = scale.corner.x(), g[2] = g[4] = 0, g[1] = cell;
    g[3] = scale.corner.y() + (north_first ? map.report.rows * cell : 0),
    g[5] = north_first ? -cell : cell;
    map.report.notes.push_back(
        "no georeference: cells of " + number_text(cell) + " m, lower-left corner at (" +
        number_text(scale.corner.x()) + ", " + number_text(scale.corner.y()) + ")" +
        (npy ? (north_first ? ", first row north" : ", first row south") : ""));
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
  const RasterCrs& declared = map.header.crs;
  // Local engineering grids often come without a CRS: metres are the only sensible assumption then.
  if (!declared.declared) {
    report.notes.push_back("no CRS: coordinates and heights are taken as metres");
  } else {
    report.crs = declared.name;
    if (declared.degrees) {
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
      report.metres = declared.metres;
      report.unit = declared.unit;
      map.crs_wkt = declared.wkt;
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
  const std::string& unit = map.header.height_unit;
  const RasterCrs& declared = map.header.crs;
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
  // Files write FT, Foot and foot.
  const auto* const known =
      std::find_if(std::begin(kUnits), std::end(kUnits),
                   [&](const Unit& each) { return lower_case(each.name) == lower_case(unit); });
  if (known != std::end(kUnits)) {
    report.height_metres = known->metres;
    if (known->metres != 1) report.height_unit = unit;
  } else if (!unit.empty()) {
    report.notes.push_back(
        "heights in '" + unit +
        "', an unknown unit: taken as metres; to assign one: " + map.edit("-units ft"));
  } else if (declared.declared && declared.vertical) {
    report.height_metres = declared.height_metres;
    report.height_unit = declared.height_unit;
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

/// Completes a remedy that ends with a GeoTIFF, which a build without GDAL cannot read.
std::string usable_remedy(const std::string& remedy) {
#ifndef NAVVY_WITH_GDAL
  for (const char* tiff : {"OUT.tif", "GTiff", "TILED"})
    if (remedy.find(tiff) != std::string::npos)
      return remedy +
             "; this build, which has no GDAL, reads no GeoTIFF: make an .asc of it with "
             "gdal_translate -of AAIGrid";
#endif
  return remedy;
}

}  // namespace

std::string number_text(double value, const char* format) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

void MapName::fail(const std::string& part, const std::string& value, const std::string& rule,
                   const std::string& remedy) const {
  // Faults of the file itself name the element; parts of a ground have their own names.
  const bool of_ground = element == "terrain" && part != "at" && part != "size";
  const std::string where = part.empty() ? element : of_ground ? part : element + "/" + part;
  throw InputError(
      Fault{Fault::Severity::kError, file, 0, where, value, rule, usable_remedy(remedy)});
}

std::string MapFile::edit(const std::string& option) const {
  if (header.editable) return "gdal_edit.py " + option + " IN";
  return "gdal_translate IN OUT.tif, then gdal_edit.py " + option + " OUT.tif";
}

MapFile::MapFile(const MapName& map, const scene::RasterScale& how_scaled, MapReader reader)
    : name(map), scale(how_scaled) {
  open(*this, reader);
  read_transform(*this);
  read_crs(*this);
  read_height_unit(*this);
}

}  // namespace navvy::heightfield
