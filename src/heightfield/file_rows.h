// SPDX-License-Identifier: Apache-2.0
// Heights of the ground in the units and datum of the file that it came from.
#pragma once

#include <vector>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// Value that exports write where a map has no height.
inline constexpr double kExportNodata = -9999;

/// Computes rows [y0, y1) of the whole site, row y0 first, x fastest, in the unit of the file; in
/// double up to the final rounding to float.
void file_rows(const Terrain& terrain, int y0, int y1, std::vector<float>& out);

}  // namespace navvy::heightfield
