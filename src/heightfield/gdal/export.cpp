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
// If no other thread is available, the next rows are computed when they are needed.
constexpr auto kWhereThereIsSpace = std::launch::async | std::launch::deferred;
// Rows computed at once: many, because layers that depend on neighbours also compute the rows
// beside them.
constexpr int kChunkRows = 8 * kStripRows;

/// Fills `out` with rows [y0, y1) of the site, row y0 first. Called by one thread at a time.
using RowSource = std::function<void(int y0, int y1, std::vector<float>& out)>;

/// One band of the file: the source of its values; name and unit are empty where it has none.
struct Band {
  RowSource rows;
  std::string name, unit;
};

/// Returns the unit of the heights by a name that readers of GDAL know; empty for a rare one, which
/// only the CRS can express.
std::string height_unit(const GroundSetup& setup) {
  if (setup.file_height_unit == 1) return "m";
  // The international foot and the US survey foot differ in the sixth digit.
  if (std::abs(setup.file_height_unit - 0.3048) < 1e-9) return "ft";
  if (std::abs(setup.file_height_unit - 1200.0 / 3937.0) < 1e-9) return "US survey foot";
  return "";
}

// Nine digits read back to the same float.
std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// Removes a file that is not complete.
struct HalfFile {
  std::string path;
  bool whole = false;
  ~HalfFile() {
    if (!whole) ::unlink(path.c_str());
  }
};

// Creates the file, its georeference and metadata, and then writes band after band.
void write(const GroundSetup& setup, const std::vector<Band>& bands, const std::string& path) {
  const int nx = setup.nx, ny = setup.ny;
  const std::string part = partial_name(path);
  HalfFile half{part};
  GdalSession session;
  // GDAL reports some failures only through its error handler, so both are checked each time.
  const auto check = [&](bool good, const char* action) {
    if (good && session.errors().empty()) return;
    throw FileError("cannot write '" + path + "': " + session.cause(action));
  };
  // Bands are stored one after the other; a file of one band needs no option.
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
  double transform[6] = {setup.easting, step, 0, setup.northing + ny * step, 0, -step};
  data->SetGeoTransform(transform);
  if (!setup.crs_wkt.empty()) {
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.importFromWkt(setup.crs_wkt.c_str()) == OGRERR_NONE) data->SetSpatialRef(&crs);
  }
  // Readers of heights can see that some were never measured.
  if (setup.filled_share > 0) {
    data->SetMetadataItem("NAVVY_FILLED_SHARE", number_text(setup.filled_share).c_str());
    data->SetMetadataItem("NAVVY_FILLED_FROM_M", number_text(setup.filled_from).c_str());
  }
  // GDAL has one nodata value for all bands of a GeoTIFF.
  data->GetRasterBand(1)->SetNoDataValue(kExportNodata);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    GDALRasterBand* band = data->GetRasterBand(static_cast<int>(b) + 1);
    if (!bands[b].name.empty()) band->SetDescription(bands[b].name.c_str());
    if (!bands[b].unit.empty()) band->SetUnitType(bands[b].unit.c_str());
    // Writes some strips at a time from the north down; while GDAL compresses them another thread
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
  // Flushes; a full disk shows here at the latest.
  data.reset();
  // GDAL writes what GeoTIFF cannot express about an exotic CRS beside the file, under the wrong
  // name, so it is removed.
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
  write(terrain.setup(), bands, path);
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
          // Computed in double, as file_rows does.
          value = static_cast<float>((static_cast<double>(value) + setup.height_offset) /
                                     setup.file_height_unit);
    };
    out.push_back({rows, band.name, band.height ? height_unit(setup) : band.unit});
  }
  if (out.empty()) throw Error("write_geotiff: no band for '" + path + "'");
  write(setup, out, path);
}

}  // namespace navvy::heightfield
