// SPDX-License-Identifier: Apache-2.0
#include "record/terrain_files.h"

#include <vector>

#include "core/error.h"
#include "core/long_work.h"
#include "map/map_maker.h"
#include "sim/world_terrain.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::record {

void write_terrain(const sim::World& world, const std::string& path) {
  const LongWork work("a terrain file was being written");
#ifdef NAVVY_WITH_GDAL
  const heightfield::TerrainView view = sim::terrain_view(world, heightfield::SurfaceKind::kMapped);
  std::vector<heightfield::MapBand> more;
  // A second band is written only while not all of the soil rests.
  const map::LayerInfo& loose = map::info(map::MapLayer::kLooseDepth);
  if (world.soil().counts().particles > 0)
    more.push_back({loose.name, loose.unit, [&](int y0, int y1, std::vector<float>& out) {
                      out = map::layer_values(view, loose.layer, {0, y0, view.nx(), y1});
                    }});
  heightfield::write_geotiff(view, path, more);
#else
  (void)world;
  throw FileError("cannot write '" + path +
                  "': this build has no GDAL; build with -DNAVVY_WITH_GDAL=ON");
#endif
}

}  // namespace navvy::record
