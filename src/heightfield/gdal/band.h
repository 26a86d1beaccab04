// SPDX-License-Identifier: Apache-2.0
// A layer beside the heights, as our own GeoTIFFs have them. Exists only in builds with
// NAVVY_WITH_GDAL.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace navvy::heightfield {

/// Hands the rows of the band called `name` to `take(iy, values)`, from the greatest y down, x
/// fastest, as they are in the file. False, and nothing handed, where `file` has no such band.
/// @throws InputError naming the file when it cannot be read or has not nx x ny cells.
bool read_band(const std::string& file, const std::string& name, int nx, int ny,
               const std::function<void(int iy, std::span<const float> values)>& take);

}  // namespace navvy::heightfield
