// SPDX-License-Identifier: Apache-2.0
// Reads a raster file as a design surface.
#pragma once

#include "heightfield/design_surface.h"

namespace navvy::heightfield {

/// Returns the heights of the raster file `design.file` of `scene` at the columns of `site`. A file
/// without coordinates is placed with its lower-left corner at that of the site. @throws InputError
/// as make_design.
DesignSurface import_design(const scene::Scene& scene, const scene::Design& design,
                            const Terrain& site);

}  // namespace navvy::heightfield
