// SPDX-License-Identifier: Apache-2.0
#include "heightfield/gdal/band.h"

#include <gdal_priv.h>

#include <memory>
#include <vector>

#include "core/error.h"
#include "heightfield/gdal/gdal_session.h"
#include "heightfield/map_files/beside.h"

namespace navvy::heightfield {

// Bands are found by their description, so that their order may change.
bool read_band(const std::string& file, const std::string& name, int nx, int ny,
               const std::function<void(int iy, std::span<const float> values)>& take) {
  GdalSession session;
  const auto fail = [&](const std::string& value, const std::string& rule) {
    throw InputError(Fault{Fault::Severity::kError, file, 0, "band '" + name + "'", value, rule,
                           "a run's folder holds the files of one run, as it wrote them"});
  };
  const std::vector<std::string> beside = files_beside(file);
  std::vector<const char*> siblings;
  siblings.reserve(beside.size() + 1);
  for (const std::string& one : beside) siblings.push_back(one.c_str());
  siblings.push_back(nullptr);
  const char* const drivers[] = {"GTiff", nullptr};
  const std::unique_ptr<GDALDataset> data(GDALDataset::Open(
      file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, siblings.data()));
  if (!data) fail("", session.cause("is not a GeoTIFF"));
  GDALRasterBand* band = nullptr;
  for (int b = 1; b <= data->GetRasterCount(); ++b)
    if (data->GetRasterBand(b)->GetDescription() == name) band = data->GetRasterBand(b);
  if (band == nullptr) return false;
  if (data->GetRasterXSize() != nx || data->GetRasterYSize() != ny)
    fail(std::to_string(data->GetRasterXSize()) + " x " + std::to_string(data->GetRasterYSize()),
         "the site has " + std::to_string(nx) + " x " + std::to_string(ny) + " columns");
  std::vector<float> row(static_cast<std::size_t>(nx));
  // Row 0 of the file is the northern edge.
  for (int r = 0; r < ny; ++r) {
    if (band->RasterIO(GF_Read, 0, r, nx, 1, row.data(), nx, 1, GDT_Float32, 0, 0, nullptr) !=
        CE_None)
      fail("row " + std::to_string(r), session.cause("cannot be read"));
    take(ny - 1 - r, row);
  }
  return true;
}

}  // namespace navvy::heightfield
