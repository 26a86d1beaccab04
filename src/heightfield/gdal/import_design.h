// SPDX-License-Identifier: Apache-2.0
// Reads a raster as design surface. Exists only in builds with NAVVY_WITH_GDAL.
#pragma once

#include "heightfield/design_surface.h"

namespace navvy::heightfield {

/// Reads `design.file` onto the columns of `site`. A file without coordinates of its own begins at
/// the lower-left corner of the site. @throws InputError as make_design.
DesignSurface import_design(const scene::Design& design, const Terrain& site);

}  // namespace navvy::heightfield
