// SPDX-License-Identifier: Apache-2.0
// Passes the layers to heightfield's writer, which is the only place with GDAL, as bands that are
// computed row by row.
#include "core/error.h"
#include "formats/formats.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::formats {
namespace {

void write_geotiff(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                   const std::string& path) {
#ifdef NAVVY_WITH_GDAL
  // Rows are copied piece by piece; no layer is copied whole.
  std::vector<heightfield::MapBand> bands;
  for (const map::MapLayer layer : layers)
    bands.push_back({map::info(layer).name, map::info(layer).unit,
                     [&map, layer](int y0, int y1, std::vector<float>& out) {
                       out = map.copy(layer, {0, y0, map.nx(), y1});
                     },
                     map::info(layer).height()});
  heightfield::write_geotiff(map.setup(), bands, path);
#else
  (void)map, (void)layers;
  throw FileError("cannot write '" + path +
                  "': this build has no GDAL; build with -DNAVVY_WITH_GDAL=ON");
#endif
}

}  // namespace

MapFormat geotiff_format() {
  return {.name = "geotiff",
          .extension = ".tif",
          .meaning = "GeoTIFF, one band a layer, georeferenced",
          .by_default = map::default_layers(),
          .write = write_geotiff};
}

}  // namespace navvy::formats
