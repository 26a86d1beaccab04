// SPDX-License-Identifier: Apache-2.0
// NPY arrays as maps: GDAL has no driver for them, so that every build reads them here.
#include <cstdint>
#include <cstring>
#include <utility>

#include "heightfield/map_files/npy.h"
#include "heightfield/map_files/plain_rasters.h"

namespace navvy::heightfield {
namespace {

/// The numbers of an NPY file, which are in memory.
class NpySource final : public RasterSource {
 public:
  explicit NpySource(NpyGrid grid) : grid_(std::move(grid)) {}
  void prepare(const CellRect& /*cells*/) override {}
  void read(const CellRect& cells, double* out) override {
    switch (grid_.type) {
      case NpyType::kFloat32:
        return take<float>(cells, out);
      case NpyType::kFloat64:
        return take<double>(cells, out);
      case NpyType::kInt16:
        return take<std::int16_t>(cells, out);
      case NpyType::kInt32:
        return take<std::int32_t>(cells, out);
      case NpyType::kUint16:
        return take<std::uint16_t>(cells, out);
      case NpyType::kUint8:
        return take<std::uint8_t>(cells, out);
    }
  }

 private:
  /// Copies numbers one by one, as those of a file need not be aligned.
  template <class T>
  void take(const CellRect& cells, double* out) const {
    for (int row = cells.y0; row < cells.y1; ++row)
      for (int column = cells.x0; column < cells.x1; ++column) {
        T value;
        const std::size_t at =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns) +
            static_cast<std::size_t>(column);
        std::memcpy(&value, grid_.bytes.data() + at * sizeof value, sizeof value);
        *out++ = static_cast<double>(value);
      }
  }

  NpyGrid grid_;
};

}  // namespace

OpenRaster open_npy(const MapName& name) {
  NpyGrid grid = read_npy(name.file);
  OpenRaster out;
  RasterHeader& header = out.header;
  header.kind = RasterHeader::Kind::kArray;
  header.format = "NumPy NPY";
  header.columns = grid.columns;
  header.rows = grid.rows;
  header.has_bytes = grid.type == NpyType::kUint8;
  header.block_x = header.columns;
  header.block_bytes = 8.0 * header.columns;
  header.for_gdal = false;
  out.source = std::make_unique<NpySource>(std::move(grid));
  return out;
}

}  // namespace navvy::heightfield
