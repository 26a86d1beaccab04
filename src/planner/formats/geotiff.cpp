// SPDX-License-Identifier: Apache-2.0
// GDAL stays where it is: this hands bands to heightfield's writer.
#include "core/error.h"
#include "planner/formats/formats.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::planner {

void write_geotiff(const TerrainMap& map, const std::vector<Layer>& layers,
                   const std::string& path) {
#ifdef NAVVY_WITH_GDAL
  // Rows by rows: nothing is copied whole.
  std::vector<heightfield::MapBand> bands;
  for (const Layer layer : layers)
    bands.push_back({info(layer).name, info(layer).unit,
                     [&map, layer](int y0, int y1, std::vector<float>& out) {
                       out = map.copy(layer, {0, y0, map.nx(), y1});
                     },
                     info(layer).height});
  heightfield::write_geotiff(map.setup(), bands, path);
#else
  (void)map, (void)layers;
  throw FileError("cannot write '" + path +
                  "': this build has no GDAL; build with -DNAVVY_WITH_GDAL=ON");
#endif
}

}  // namespace navvy::planner
