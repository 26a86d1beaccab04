// SPDX-License-Identifier: Apache-2.0
// GeoTIFF in the coordinates of the file the site came from. Written beside the target and renamed
// at the end.
#include "heightfield/gdal/export.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <future>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "heightfield/file_rows.h"
#include "heightfield/gdal/gdal_session.h"

namespace navvy::heightfield {
namespace {

// Rows that are held and compressed together.
constexpr int kStripRows = 32;
// Without another thread to be had the next rows are computed when they are needed.
constexpr auto kWhereThereIsSpace = std::launch::async | std::launch::deferred;
// Rows computed at once: many, as layers that look around compute the rows beside them, too.
constexpr int kChunkRows = 8 * kStripRows;

/// Fills `out` with rows [y0, y1) of the rectangle, row y0 first. Called by one thread at a time.
using RowSource = std::function<void(int y0, int y1, std::vector<float>& out)>;

/// One band of the file: where its values come from; name and unit, empty where it has none.
struct Band {
  RowSource rows;
  std::string name, unit;
};

/// Of the file's heights, by a name that GDAL's readers know; empty for a rare one, which only its
/// CRS can tell.
std::string height_unit(const GroundSetup& setup) {
  if (setup.file_height_unit == 1) return "m";
  // The international foot and the one of US surveys differ in the sixth digit.
  if (std::abs(setup.file_height_unit - 0.3048) < 1e-9) return "ft";
  if (std::abs(setup.file_height_unit - 1200.0 / 3937.0) < 1e-9) return "US survey foot";
  return "";
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// Removes what is half written, unless told that it is whole.
struct HalfFile {
  std::string path;
  bool whole = false;
  ~HalfFile() {
    if (!whole) ::unlink(path.c_str());
  }
};

void write(const GroundSetup& setup, const CellRect& rect, const std::vector<Band>& bands,
           const std::string& path) {
  const int nx = rect.x1 - rect.x0, ny = rect.y1 - rect.y0;
  const std::string part = partial_name(path);
  HalfFile half{part};
  GdalSession session;
  // GDAL reports some failures only through its error handler, so both are asked each time.
  const auto check = [&](bool good, const char* action) {
    if (good && session.errors().empty()) return;
    throw FileError("cannot write '" + path + "': " + session.cause(action));
  };
  // Bands one after the other; a file of one band is as it always was.
  const char* const options[] = {"COMPRESS=DEFLATE",
                                 "PREDICTOR=3",
                                 "BLOCKYSIZE=32",
                                 "BIGTIFF=IF_SAFER",
                                 bands.size() > 1 ? "INTERLEAVE=BAND" : nullptr,
                                 nullptr};
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  check(driver != nullptr, "this GDAL cannot write GeoTIFF");
  std::unique_ptr<GDALDataset> data(driver->Create(part.c_str(), nx, ny,
                                                   static_cast<int>(bands.size()), GDT_Float32,
                                                   const_cast<char**>(options)));
  check(data != nullptr, "the file cannot be created");
  // Row 0 of the file is the northern edge.
  const double step = setup.cell / setup.file_unit;
  double transform[6] = {setup.easting + rect.x0 * step,  step, 0,
                         setup.northing + rect.y1 * step, 0,    -step};
  data->SetGeoTransform(transform);
  if (!setup.crs_wkt.empty()) {
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.importFromWkt(setup.crs_wkt.c_str()) == OGRERR_NONE) data->SetSpatialRef(&crs);
  }
  // Who reads heights can see that some were never measured.
  if (setup.filled_share > 0) {
    data->SetMetadataItem("NAVVY_FILLED_SHARE", number_text(setup.filled_share).c_str());
    data->SetMetadataItem("NAVVY_FILLED_FROM_M", number_text(setup.filled_from).c_str());
  }
  // GDAL has one such value for all bands of a GeoTIFF.
  data->GetRasterBand(1)->SetNoDataValue(kExportNodata);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    GDALRasterBand* band = data->GetRasterBand(static_cast<int>(b) + 1);
    if (!bands[b].name.empty()) band->SetDescription(bands[b].name.c_str());
    if (!bands[b].unit.empty()) band->SetUnitType(bands[b].unit.c_str());
    // From the north down, some strips of the file at a time; while they are packed another thread
    // computes the next.
    std::vector<float> now, next;
    const auto compute = [&](int top) {
      bands[b].rows(ny - std::min(top + kChunkRows, ny), ny - top, next);
    };
    compute(0);
    for (int top = 0; top < ny; top += kChunkRows) {
      std::swap(now, next);
      std::future<void> coming;
      if (top + kChunkRows < ny) coming = std::async(kWhereThereIsSpace, compute, top + kChunkRows);
      const int bottom = std::min(top + kChunkRows, ny);
      for (int row = top; row < bottom; ++row)
        check(band->RasterIO(GF_Write, 0, row, nx, 1,
                             now.data() + static_cast<std::size_t>(bottom - 1 - row) * nx, nx, 1,
                             GDT_Float32, 0, 0, nullptr) == CE_None,
              "a row cannot be written");
      if (coming.valid()) coming.get();
    }
  }
  data.reset();  // flushes; a full disk shows here at the latest
  // What GeoTIFF cannot say about an exotic CRS, GDAL puts beside the file: under the wrong name,
  // so away with it.
  ::unlink((part + ".aux.xml").c_str());
  check(true, "");
  half.whole = true;
  commit_file(path);
}

}  // namespace

void write_geotiff(const Terrain& terrain, const std::string& path,
                   const std::vector<MapBand>& more) {
  // Without its unit, a reader takes heights for metres, or for the unit of the coordinates.
  std::vector<Band> bands = {
      {[&](int y0, int y1, std::vector<float>& out) { file_rows(terrain, y0, y1, out); }, "",
       height_unit(terrain.setup())}};
  for (const MapBand& band : more) bands.push_back({band.rows, band.name, band.unit});
  write(terrain.setup(), {0, 0, terrain.nx(), terrain.ny()}, bands, path);
}

void write_geotiff(const Terrain& terrain, const CellRect& rect, std::span<const float> values,
                   const std::string& path) {
  const auto nx = static_cast<std::size_t>(std::max(rect.x1 - rect.x0, 0));
  if (rect.empty() || values.size() != nx * static_cast<std::size_t>(rect.y1 - rect.y0))
    // A fault of the caller, not of the file.
    throw Error("write_geotiff: " + std::to_string(values.size()) +
                " values do not fill the rectangle for '" + path + "'");
  const auto rows = [&](int y0, int y1, std::vector<float>& out) {
    out.assign(values.begin() + static_cast<std::ptrdiff_t>(y0 * nx),
               values.begin() + static_cast<std::ptrdiff_t>(y1 * nx));
  };
  write(terrain.setup(), rect, {{rows, "", ""}}, path);
}

void write_geotiff(const GroundSetup& setup, const std::vector<MapBand>& bands,
                   const std::string& path) {
  const auto nx = static_cast<std::size_t>(setup.nx);
  std::vector<Band> out;
  for (const MapBand& band : bands) {
    const auto rows = [&setup, &band, &path, nx](int y0, int y1, std::vector<float>& to) {
      band.rows(y0, y1, to);
      if (to.size() != nx * static_cast<std::size_t>(y1 - y0))
        throw Error("write_geotiff: " + std::to_string(to.size()) + " values of '" + band.name +
                    "' do not fill rows " + std::to_string(y0) + " to " + std::to_string(y1) +
                    " for '" + path + "'");
      for (float& value : to)
        if (value != value)
          value = static_cast<float>(kExportNodata);
        else if (band.height)
          // In double up to here, as file_rows does.
          value = static_cast<float>((static_cast<double>(value) + setup.height_offset) /
                                     setup.file_height_unit);
    };
    out.push_back({rows, band.name, band.height ? height_unit(setup) : band.unit});
  }
  if (out.empty()) throw Error("write_geotiff: no band for '" + path + "'");
  write(setup, {0, 0, setup.nx, setup.ny}, out, path);
}

}  // namespace navvy::heightfield
