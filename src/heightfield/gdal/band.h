// SPDX-License-Identifier: Apache-2.0
// Reads additional bands of GeoTIFF files that Navvy wrote. Only in builds with NAVVY_WITH_GDAL.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace navvy::heightfield {

/// Reads the band called `name` of the GeoTIFF `file`, row by row. Each row is passed to `take(iy,
/// values)`, from the largest y to the smallest, with the values of the file, x fastest. Returns
/// false, without calling `take`, if the file has no such band.
/// @throws InputError naming the file if it cannot be read or does not have nx x ny cells.
bool read_band(const std::string& file, const std::string& name, int nx, int ny,
               const std::function<void(int iy, std::span<const float> values)>& take);

}  // namespace navvy::heightfield
