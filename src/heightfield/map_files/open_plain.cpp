// SPDX-License-Identifier: Apache-2.0
#include "core/error.h"
#include "heightfield/map_files/npy.h"
#include "heightfield/map_files/plain_rasters.h"

namespace navvy::heightfield {

// Decides by content and not by the ending of the name.
OpenRaster open_plain(const MapName& name) {
  if (is_npy_file(name.file)) return open_npy(name);
  if (is_png_file(name.file)) return open_png(name);
  if (is_ascii_grid(name.file)) return open_ascii_grid(name);
  // The line to change is one of the scene.
  throw InputError(Fault{
      Fault::Severity::kError, name.scene.empty() ? name.file : name.scene, name.line,
      name.element + "/file", name.file,
      "is neither 16-bit PNG, NPY nor ESRI ASCII grid, and this build, which has no GDAL, reads no "
      "other map",
      "convert it: gdal_translate -of AAIGrid IN OUT.asc (apt-get install gdal-bin), or build "
      "Navvy with GDAL (apt-get install libgdal-dev, cmake -DNAVVY_WITH_GDAL=ON)"});
}

}  // namespace navvy::heightfield
