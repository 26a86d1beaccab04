// SPDX-License-Identifier: Apache-2.0
#include "heightfield/gdal/gdal_raster.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <utility>
#include <vector>

#include "core/error.h"
#include "heightfield/gdal/gdal_session.h"
#include "heightfield/map_files/ascii_words.h"
#include "heightfield/map_files/beside.h"

namespace navvy::heightfield {
namespace {

bool is_driver(GDALDataset& data, const char* name) {
  return EQUAL(data.GetDriver()->GetDescription(), name);
}

/// The first band of an open dataset.
class GdalSource final : public RasterSource {
 public:
  GdalSource(std::string path, std::unique_ptr<GDALDataset> data)
      : path_(std::move(path)), data_(std::move(data)), band_(data_->GetRasterBand(1)) {}
  ~GdalSource() override {
    // Closing may report failures.
    const GdalSession session;
    data_.reset();
  }

  /// Reads an ESRI ASCII map in the order of its rows up to the last one needed. GDAL finds the
  /// start of a row by reading those before it, and continues after a row that fails: for the last
  /// row of a truncated file it tries 2^rows times.
  void prepare(const CellRect& cells) override {
    if (!is_driver(*data_, "AAIGrid")) return;
    check_words(path_, static_cast<std::int64_t>(cells.y1) * data_->GetRasterXSize());
    double value = 0;
    for (int row = 0; row < cells.y1; ++row) read({0, row, 1, row + 1}, &value);
  }

  void read(const CellRect& cells, double* out) override {
    const GdalSession session;
    const int nx = cells.x1 - cells.x0, ny = cells.y1 - cells.y0;
    if (band_->RasterIO(GF_Read, cells.x0, cells.y0, nx, ny, out, nx, ny, GDT_Float64, 0, 0,
                        nullptr) != CE_None)
      throw RowError(cells.y0, session.cause("cannot be read"));
  }

 private:
  std::string path_;
  std::unique_ptr<GDALDataset> data_;
  GDALRasterBand* band_;
};

/// Opens a file with the drivers that we accept: others reach files elsewhere, or the network.
std::unique_ptr<GDALDataset> open(const MapName& name, const GdalSession& session) {
  std::vector<std::string> beside;
  try {
    beside = files_beside(name.file);
  } catch (const FileError& failure) {
    name.fail("", "", failure.what(), "move that file away, or replace it");
  }
  std::vector<const char*> siblings;
  siblings.reserve(beside.size() + 1);
  for (const std::string& one : beside) siblings.push_back(one.c_str());
  siblings.push_back(nullptr);
  // Doubles, because the ASCII driver infers integers from the first values.
  const char* const drivers[] = {"GTiff", "AAIGrid", "PNG", nullptr};
  const char* const options[] = {"DATATYPE=Float64", nullptr};
  std::unique_ptr<GDALDataset> data(GDALDataset::Open(
      name.file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, options, siblings.data()));
  if (!data || data->GetRasterCount() < 1)
    name.fail("", "", session.cause("is neither GeoTIFF, ESRI ASCII, PNG nor NPY"),
              "convert it with gdal_translate -of GTiff");
  return data;
}

/// Reads what the band declares about its values.
void describe_band(GDALRasterBand& band, RasterHeader& header) {
  int has = 0;
  const double nodata = band.GetNoDataValue(&has);
  if (has != 0) header.nodata = nodata;
  const double scale = band.GetScale(&has);
  if (has != 0) header.scale = scale;
  const double offset = band.GetOffset(&has);
  if (has != 0) header.offset = offset;
  header.height_unit = band.GetUnitType() != nullptr ? band.GetUnitType() : "";
  header.has_bytes = band.GetRasterDataType() == GDT_Byte;
  header.has_palette = band.GetColorTable() != nullptr;
  band.GetBlockSize(&header.block_x, &header.block_y);
}

RasterCrs crs_of(const OGRSpatialReference* declared) {
  RasterCrs crs;
  if (declared == nullptr || declared->IsEmpty()) return crs;
  crs.declared = true;
  crs.name = declared->GetName() != nullptr ? declared->GetName() : "unnamed";
  crs.degrees = declared->IsGeographic() != 0;
  const char* unit = nullptr;
  crs.metres = declared->GetLinearUnits(&unit);
  if (unit != nullptr) crs.unit = unit;
  char* wkt = nullptr;
  const char* const format[] = {"FORMAT=WKT2_2019", nullptr};
  if (declared->exportToWkt(&wkt, format) == OGRERR_NONE && wkt != nullptr) crs.wkt = wkt;
  CPLFree(wkt);
  crs.vertical = declared->IsVertical() != 0;
  if (!crs.vertical) return crs;
  const char* height_unit = nullptr;
  crs.height_metres = declared->GetTargetLinearUnits("VERT_CS", &height_unit);
  if (height_unit != nullptr) crs.height_unit = height_unit;
  return crs;
}

}  // namespace

OpenRaster open_with_gdal(const MapName& name) {
  const GdalSession session;
  std::unique_ptr<GDALDataset> data = open(name, session);
  GDALRasterBand& band = *data->GetRasterBand(1);
  if (GDALDataTypeIsComplex(band.GetRasterDataType()))
    name.fail("", "", "holds complex numbers", "give a file of heights");
  OpenRaster out;
  RasterHeader& header = out.header;
  if (is_driver(*data, "PNG")) header.kind = RasterHeader::Kind::kPicture;
  if (is_driver(*data, "AAIGrid")) header.kind = RasterHeader::Kind::kAsciiGrid;
  header.editable = is_driver(*data, "GTiff");
  header.format = data->GetDriver()->GetMetadataItem(GDAL_DMD_LONGNAME);
  header.columns = data->GetRasterXSize();
  header.rows = data->GetRasterYSize();
  header.bands = data->GetRasterCount();
  describe_band(band, header);
  std::array<double, 6> place = {};
  if (data->GetGeoTransform(place.data()) == CE_None) header.place = place;
  // GDAL has already moved the corner of point-registered files by half a cell.
  const char* registration = data->GetMetadataItem(GDALMD_AREA_OR_POINT);
  header.point_registered = registration != nullptr && EQUAL(registration, GDALMD_AOP_POINT);
  // A block of pixel-interleaved bands holds all bands.
  const char* interleave = data->GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
  const int bands_in_block = interleave != nullptr && EQUAL(interleave, "PIXEL") ? header.bands : 1;
  // 8 bytes are those of the largest type, as complex numbers have been refused.
  header.block_bytes = static_cast<double>(header.block_x) * header.block_y * 8 * bands_in_block;
  header.crs = crs_of(data->GetSpatialRef());
  out.source = std::make_unique<GdalSource>(name.file, std::move(data));
  return out;
}

bool same_crs(const std::string& a, const std::string& b) {
  OGRSpatialReference one, other;
  one.importFromWkt(a.c_str());
  other.importFromWkt(b.c_str());
  one.StripVertical();
  other.StripVertical();
  const char* const options[] = {"IGNORE_COORDINATE_EPOCH=YES",
                                 "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS", nullptr};
  return one.IsSame(&other, options) != 0;
}

}  // namespace navvy::heightfield
