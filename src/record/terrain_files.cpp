// SPDX-License-Identifier: Apache-2.0
#include "record/terrain_files.h"

#include "core/error.h"
#ifdef NAVVY_WITH_GDAL
#include "heightfield/gdal/export.h"
#endif

namespace navvy::record {

void write_terrain(const heightfield::Ground& ground, const std::string& path) {
#ifdef NAVVY_WITH_GDAL
  heightfield::write_geotiff(ground, path);
#else
  (void)ground;
  throw FileError("cannot write '" + path + "': this build has no GDAL; build with -DNAVVY_WITH_GDAL=ON");
#endif
}

}  // namespace navvy::record
