// SPDX-License-Identifier: Apache-2.0
#include "record/terrain_files.h"

#include <vector>

#include "core/error.h"
#include "sim/world_terrain.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::record {
namespace {

// Beside the heights, in files of ground that does not all rest.
[[maybe_unused]] const std::vector<std::string> kAwake = {"loose_depth"};

}  // namespace

void write_terrain(const sim::World& world, const std::string& path) {
#ifdef NAVVY_WITH_GDAL
  const bool active = world.soil_counts().particles > 0;
  heightfield::write_geotiff(sim::terrain_view(world, heightfield::SurfaceKind::kMapped), path,
                             active ? kAwake : std::vector<std::string>{});
#else
  (void)world;
  throw FileError("cannot write '" + path +
                  "': this build has no GDAL; build with -DNAVVY_WITH_GDAL=ON");
#endif
}

}  // namespace navvy::record
