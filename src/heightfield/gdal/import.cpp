// SPDX-License-Identifier: Apache-2.0
// Maps come from everywhere, so each step names what it refuses and how to mend the file, and notes what it had to
// guess: open, georeference, CRS, unit of heights, place of the site, cells, gaps.
#include "heightfield/gdal/import.h"

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "core/error.h"
#include "core/hash.h"
#include "core/limits.h"
#include "heightfield/ascii_words.h"
#include "heightfield/gdal/beside.h"
#include "heightfield/gdal/session.h"

namespace navvy::heightfield {
namespace {

// Cells round the site, for interpolation and for filling gaps at its edge.
constexpr int kMargin = 2;
// No ground lies above or below this; such a number is a nodata value that nobody declared [m].
constexpr double kHighest = 12000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string number(double value, const char* format = "%.10g") {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

// One map being read: throws with its name.
struct Map {
  explicit Map(const scene::Scene& w) : world(w) {}
  const scene::Scene& world;
  GdalSession session;  // outlives the dataset, whose closing may complain
  std::unique_ptr<GDALDataset> data;
  GDALRasterBand* band = nullptr;
  TerrainReport report;
  // Coordinates of the map's lower-left corner and edges of a cell in file units; which way rows and columns run.
  double x_min = 0, y_min = 0, step_x = 1, step_y = 1;
  bool columns_fall = false, rows_fall = true;
  int block_x = 1, block_y = 1;
  double block_bytes = 0;  // decoded

  [[noreturn]] void fail(const std::string& element, const std::string& value, const std::string& rule,
                         const std::string& remedy) const {
    throw InputError(Fault{Fault::Severity::kError, world.ground.file, 0, element, value, rule, remedy});
  }
};

void open(Map& map) {
  const std::string& file = map.world.ground.file;
  map.report.file = file;
  // Asked first, as GDAL's own words for a missing file are of no help.
  VSIStatBufL status;
  if (VSIStatL(file.c_str(), &status) != 0) map.fail("terrain", "", "no such file", "check the path");
  if (VSI_ISDIR(status.st_mode)) map.fail("terrain", "", "is a directory", "name the GeoTIFF or ESRI ASCII file in it");
  if (!VSI_ISREG(status.st_mode)) map.fail("terrain", "", "is no plain file", "save the map as a file");
  std::vector<std::string> beside;
  try {
    beside = files_beside(file);
  } catch (const FileError& failure) {
    map.fail("terrain", "", failure.what(), "move that file away, or replace it");
  }
  std::vector<const char*> siblings;
  siblings.reserve(beside.size() + 1);
  for (const std::string& name : beside) siblings.push_back(name.c_str());
  siblings.push_back(nullptr);
  // Doubles, because the ASCII driver guesses whole numbers from the first values it sees.
  const char* const drivers[] = {"GTiff", "AAIGrid", nullptr};
  const char* const options[] = {"DATATYPE=Float64", nullptr};
  map.data.reset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, options, siblings.data()));
  if (!map.data || map.data->GetRasterCount() < 1)
    map.fail("terrain", "", map.session.cause("is neither GeoTIFF nor ESRI ASCII"),
             "convert it with gdal_translate -of GTiff");
  map.band = map.data->GetRasterBand(1);
  if (GDALDataTypeIsComplex(map.band->GetRasterDataType()))
    map.fail("terrain", "", "holds complex numbers", "give a file of heights");
  // From here on it is a map; what is odd about it is noted, not refused.
  map.report.format = map.data->GetDriver()->GetMetadataItem(GDAL_DMD_LONGNAME);
  map.report.columns = map.data->GetRasterXSize();
  map.report.rows = map.data->GetRasterYSize();
  if (map.data->GetRasterCount() > 1)
    map.report.notes.push_back(std::to_string(map.data->GetRasterCount()) + " bands: the first one is taken as height");
  if (map.band->GetRasterDataType() == GDT_Byte)
    map.report.notes.push_back("8-bit heights: steps of a whole unit, and nodata may have become 0");
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
    map.fail("terrain", std::to_string(block_x) + " x " + std::to_string(block_y),
             "is stored in blocks too large to read", "rewrite it with gdal_translate -co TILED=YES");
}

void read_transform(Map& map) {
  double g[6];
  if (map.data->GetGeoTransform(g) != CE_None) {
    map.report.notes.push_back("no georeference: cells of 1 m, lower-left corner at (0, 0)");
    g[0] = g[2] = g[4] = 0, g[1] = 1, g[3] = map.report.rows, g[5] = -1;
  }
  for (const double value : g)
    if (!std::isfinite(value))
      map.fail("georeference", number(value), "must be finite", "repair it with gdal_edit.py -a_ullr");
  if (g[2] != 0 || g[4] != 0)
    map.fail("georeference", number(g[2]) + ", " + number(g[4]), "the map is turned against its coordinate axes",
             "straighten it with gdalwarp");
  if (g[1] == 0 || g[5] == 0) map.fail("georeference", "0", "cells need an extent", "repair it with gdal_edit.py -tr");
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
void refuse_degrees(Map& map) {
  const Vec2 middle = 0.5 * (map.report.file_min + map.report.file_max);
  const int zone = std::clamp(static_cast<int>(std::floor((middle.x() + 180) / 6)) + 1, 1, 60);
  const int epsg = (middle.y() < 0 ? 32700 : 32600) + zone;
  map.fail("CRS", map.report.crs, "coordinates are degrees, a site needs lengths",
           "reproject it: gdalwarp -t_srs EPSG:" + std::to_string(epsg) +
               " -r bilinear IN OUT; if they are metres in truth, drop the CRS: gdal_edit.py -a_srs \"\" IN");
}

void read_crs(Map& map, Ground::Setup& setup) {
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
      if (declared->exportToWkt(&wkt, format) == OGRERR_NONE && wkt != nullptr) setup.crs_wkt = wkt;
      CPLFree(wkt);
    }
  }
  if (!std::isfinite(report.metres) || !(report.metres > 0))
    map.fail("CRS", number(report.metres), "a unit of length must be > 0 m",
             "assign the right CRS with gdal_edit.py -a_srs");
  report.cell_x = map.step_x * report.metres;
  report.cell_y = map.step_y * report.metres;
  const Vec2 extent = (report.file_max - report.file_min) * report.metres;
  if (!extent.allFinite() || !report.file_min.allFinite() || !(report.cell_x > 0) || !(report.cell_y > 0))
    map.fail("georeference", number(map.step_x), "cells must have a finite size", "repair it with gdal_edit.py -tr");
}

// The unit of heights: the band's, else that of a vertical CRS, else the horizontal one.
void read_height_unit(Map& map) {
  TerrainReport& report = map.report;
  const std::string unit = map.band->GetUnitType() != nullptr ? map.band->GetUnitType() : "";
  const OGRSpatialReference* declared = map.data->GetSpatialRef();
  if (EQUAL(unit.c_str(), "m") || EQUAL(unit.c_str(), "metre") || EQUAL(unit.c_str(), "meter") ||
      EQUAL(unit.c_str(), "metres") || EQUAL(unit.c_str(), "meters")) {
    report.height_metres = 1;
  } else if (EQUAL(unit.c_str(), "ft") || EQUAL(unit.c_str(), "foot") || EQUAL(unit.c_str(), "feet")) {
    report.height_unit = unit;
    report.height_metres = 0.3048;
  } else if (EQUAL(unit.c_str(), "US survey foot") || EQUAL(unit.c_str(), "ftUS") || EQUAL(unit.c_str(), "us-ft")) {
    report.height_unit = unit;
    report.height_metres = 1200.0 / 3937.0;
  } else if (!unit.empty()) {
    report.notes.push_back("heights in '" + unit + "', which is no known unit: taken as metres");
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
    map.fail("heights", report.height_unit, "a unit of length must be > 0 m", "assign a vertical unit");
}

// Lower-left corner of the site in metres from the map's; throws when the site leaves the map.
Vec2 place_site(Map& map, Ground::Setup& setup) {
  const scene::StartGround& ground = map.world.ground;
  TerrainReport& report = map.report;
  const Vec2 extent(report.cell_x * report.columns, report.cell_y * report.rows);
  // Without a wish the site lies in the middle of the map.
  Vec2 middle = 0.5 * extent;
  if (ground.has_at) middle = ground.at_is_local ? ground.at : Vec2((ground.at - report.file_min) * report.metres);
  const Vec2 size = setup.cell * Vec2(setup.nx, setup.ny);
  const Vec2 corner = middle - 0.5 * size;
  report.site_min = report.file_min + corner / report.metres;
  report.site_max = report.site_min + size / report.metres;
  // Rounding up to blocks may reach over the edge by up to four columns, which repeat the edge.
  const Vec2 slack = Vec2::Constant(4 * setup.cell);
  const bool inside =
      ((corner + slack).array() >= 0).all() && ((corner + size - slack).array() <= extent.array()).all();
  if (!inside) {
    const auto span = [](const Vec2& low, const Vec2& high) {
      return "x " + number(low.x(), "%.3f") + " .. " + number(high.x(), "%.3f") + ", y " + number(low.y(), "%.3f") +
             " .. " + number(high.y(), "%.3f");
    };
    map.fail("terrain/at", span(report.site_min, report.site_max),
             "the site is off the map, which reaches over " + span(report.file_min, report.file_max) + " (" +
                 number(extent.x()) + " x " + number(extent.y()) + " m)",
             "move --at inside (local:X,Y counts metres from the map's lower-left corner) or make --size smaller");
  }
  setup.easting = report.site_min.x();
  setup.northing = report.site_min.y();
  setup.file_unit = report.metres;
  setup.file_height_unit = report.height_metres;
  return corner;
}

// Turns what a file says into metres, and every spelling of "no data" into NaN.
class Decoder {
 public:
  explicit Decoder(Map& map) {
    int has = 0;
    const double value = map.band->GetNoDataValue(&has);
    if (has != 0) nodata_ = static_cast<float>(value);
    has_nodata_ = has != 0;
    map.report.nodata_value = has != 0 ? "declared as " + number(value) : "none declared";
    // GDAL does not apply scale and offset itself.
    const double scale = map.band->GetScale(&has);
    if (has != 0 && std::isfinite(scale) && scale != 0) scale_ = scale;
    const double offset = map.band->GetOffset(&has);
    if (has != 0 && std::isfinite(offset)) offset_ = offset;
    metres_ = map.report.height_metres;
  }
  double operator()(double raw) const {
    // Compared in float32: a double that went through a float file is no longer equal.
    const auto single = static_cast<float>(raw);
    if (!std::isfinite(single) || (has_nodata_ && single == nodata_)) return kNaN;
    for (const double usual : {-9999.0, -9999.005859375, -32768.0, -32767.0})
      if (raw == usual) return kNaN;
    // Undeclared but usual markers were dropped by now; so is what no ground can be.
    const double height = (raw * scale_ + offset_) * metres_;
    return std::abs(height) <= kHighest ? height : kNaN;
  }

 private:
  bool has_nodata_ = false;
  float nodata_ = 0;
  double scale_ = 1, offset_ = 0, metres_ = 1;
};

/// Reads an ESRI ASCII map in the order of its rows up to the last one needed. GDAL finds the start of a row by reading
/// those before it and goes on after a row that fails: asked for the last row of a cut file it tries 2^rows times.
void find_rows(Map& map, int last_row) {
  if (std::string(map.data->GetDriver()->GetDescription()) != "AAIGrid") return;
  check_words(map.world.ground.file, (static_cast<std::int64_t>(last_row) + 1) * map.report.columns);
  for (int row = 0; row <= last_row; ++row) {
    double value = 0;
    if (map.band->RasterIO(GF_Read, 0, row, 1, 1, &value, 1, 1, GDT_Float64, 0, 0, nullptr) != CE_None)
      map.fail("row " + std::to_string(row), "", map.session.cause("cannot be read"),
               "the file is damaged: get it again");
  }
}

/// A few bytes may decode to gigabytes, and blocks that do not fit into GDAL's cache side by side are decoded for every
/// row anew.
void check_blocks(const Map& map, int x0, int x1, int y0, int y1) {
  const int blocks_x = x1 / map.block_x - x0 / map.block_x + 1, blocks_y = y1 / map.block_y - y0 / map.block_y + 2;
  const double across = blocks_x, down = blocks_y;
  const bool kept = across * map.block_bytes <= static_cast<double>(GDALGetCacheMax64());
  const double decoded = across * (kept ? down : y1 - y0 + 1.0) * map.block_bytes;
  if (decoded > limits::kMapDecodedBytes)
    map.fail("terrain", number(decoded) + " bytes",
             "more than " + number(limits::kMapDecodedBytes) +
                 " to decode for this site: its blocks hold far more than the site",
             "rewrite it with gdal_translate -co TILED=YES");
}

// Reads the cells under the site, flipped into our order; heights minus the offset, so that float keeps millimetres.
HeightRaster read_heights(Map& map, const Ground::Setup& setup, const Vec2& corner) {
  TerrainReport& report = map.report;
  // Cells that the site needs, with a margin; clamped in double, as a damaged header may give any number.
  const auto first = [](double x, double cell, int n) {
    return static_cast<int>(std::clamp(std::floor(x / cell) - kMargin, 0.0, n - 1.0));
  };
  const auto last = [](double x, double cell, int n) {
    return static_cast<int>(std::clamp(std::floor(x / cell) + kMargin, 0.0, n - 1.0));
  };
  const int x0 = first(corner.x(), report.cell_x, report.columns), y0 = first(corner.y(), report.cell_y, report.rows);
  const int x1 = last(corner.x() + setup.nx * setup.cell, report.cell_x, report.columns);
  const int y1 = last(corner.y() + setup.ny * setup.cell, report.cell_y, report.rows);
  HeightRaster raster;
  raster.nx = x1 - x0 + 1;
  raster.ny = y1 - y0 + 1;
  raster.cell_x = report.cell_x;
  raster.cell_y = report.cell_y;
  raster.x0 = (x0 + 0.5) * report.cell_x - corner.x();
  raster.y0 = (y0 + 0.5) * report.cell_y - corner.y();
  report.source_cells = static_cast<std::int64_t>(raster.nx) * raster.ny;
  // Before memory is asked for.
  if (static_cast<double>(report.source_cells) > limits::kMapCells)
    map.fail("terrain/size", std::to_string(raster.nx) + " x " + std::to_string(raster.ny) + " map cells",
             "more than " + number(limits::kMapCells) + " cells under the site",
             "choose a smaller --size or a coarser map");
  check_blocks(map, x0, x1, y0, y1);
  raster.z.resize(static_cast<std::size_t>(report.source_cells));
  const Decoder decode(map);
  std::vector<double> line(static_cast<std::size_t>(raster.nx));
  find_rows(map, map.rows_fall ? report.rows - 1 - y0 : y1);
  double sum = 0;
  std::int64_t known = 0;
  for (int iy = 0; iy < raster.ny; ++iy) {
    const int row = map.rows_fall ? report.rows - 1 - (y0 + iy) : y0 + iy;
    const int column = map.columns_fall ? report.columns - 1 - x1 : x0;
    if (map.band->RasterIO(GF_Read, column, row, raster.nx, 1, line.data(), raster.nx, 1, GDT_Float64, 0, 0, nullptr) !=
        CE_None)
      map.fail("row " + std::to_string(row), "", map.session.cause("cannot be read"),
               "the file is damaged: get it again");
    if (map.columns_fall) std::reverse(line.begin(), line.end());
    for (int ix = 0; ix < raster.nx; ++ix) {
      const double height = decode(line[static_cast<std::size_t>(ix)]);
      // The first height found stands in for the offset until the mean is known.
      if (!std::isnan(height) && known++ == 0) report.height_offset = std::floor(height);
      if (!std::isnan(height)) sum += height - report.height_offset;
      raster.at(ix, iy) = static_cast<float>(height - report.height_offset);
    }
  }
  if (known == 0)
    map.fail("terrain/at", "", "there is no height anywhere under the site, all is nodata",
             "move the site to where the map has data");
  // A whole number of metres near the mean, exact in float.
  const double shift = std::floor(sum / static_cast<double>(known));
  for (float& z : raster.z) z = static_cast<float>(z - shift);
  report.height_offset += shift;
  return raster;
}

}  // namespace

TerrainReport import_terrain(const scene::Scene& world, Ground::Setup& setup) {
  Map map(world);
  open(map);
  read_transform(map);
  read_crs(map, setup);
  read_height_unit(map);
  const Vec2 corner = place_site(map, setup);
  auto raster = std::make_shared<HeightRaster>(read_heights(map, setup, corner));
  TerrainReport& report = map.report;
  // What the report says of heights and slopes is said of the filled map, which is what the columns come from.
  report.nodata = fill_gaps(*raster);
  const auto [least, most] = std::minmax_element(raster->z.begin(), raster->z.end());
  report.lowest = *least + report.height_offset;
  report.highest = *most + report.height_offset;
  for (const scene::GroundLayer& layer : world.ground.layers)
    if (const int i = world.soil_index(layer.soil); i >= 0) {
      report.repose = world.soils[static_cast<std::size_t>(i)].friction_angle;
      break;
    }
  report.slope = slopes(*raster, report.repose);
  report.soil_cell = setup.cell;
  setup.height_offset = report.height_offset;
  setup.datum = *least - world.ground.depth;
  const double cell = setup.cell;
  // Shared, so that copies of the setup cost nothing.
  StateHash heights;
  heights.bytes(raster->z.data(), raster->z.size() * sizeof(float));
  for (const double one : {raster->cell_x, raster->cell_y, raster->x0, raster->y0}) heights.value(one);
  heights.value(raster->nx);
  setup.map_hash = heights.digest();
  setup.surface = [raster, cell](int ix, int iy) { return raster->mean((ix + 0.5) * cell, (iy + 0.5) * cell, cell); };
  return report;
}

}  // namespace navvy::heightfield
