// SPDX-License-Identifier: Apache-2.0
// Heights of the ground in the units and the vertical datum of the terrain file of a site.
#pragma once

#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// Value that exported files contain in place of an unknown height.
inline constexpr double kExportNodata = -9999;

/// Fills `out` with the heights of site rows y0 <= iy < y1, row y0 first, x fastest. Heights have
/// the unit and the vertical datum of the site's terrain file; without a file they are world z [m].
/// Computed in double precision and rounded to float last.
void file_rows(const Terrain& terrain, int y0, int y1, std::vector<float>& out);

}  // namespace navvy::heightfield
