// SPDX-License-Identifier: Apache-2.0
#include "record/terrain_files.h"

#include "core/error.h"
#include "sim/terrain_view.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::record {
namespace {

// What a map in a run's folder shows.
[[maybe_unused]] constexpr heightfield::SurfaceKind kMapped = heightfield::SurfaceKind::kColumns;

}  // namespace

void write_terrain(const sim::World& world, const std::string& path) {
#ifdef NAVVY_WITH_GDAL
  heightfield::write_geotiff(sim::terrain_view(world, kMapped), path);
#else
  (void)world;
  throw FileError("cannot write '" + path + "': this build has no GDAL; build with -DNAVVY_WITH_GDAL=ON");
#endif
}

}  // namespace navvy::record
