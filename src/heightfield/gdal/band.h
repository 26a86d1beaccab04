// SPDX-License-Identifier: Apache-2.0
// Reads a further band of our own GeoTIFFs. Exists only in builds with NAVVY_WITH_GDAL.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace navvy::heightfield {

/// Passes the rows of the band called `name` to `take(iy, values)`, from the greatest y down, x
/// fastest, with the values of the file. Returns false, without a call, where `file` has no such
/// band.
/// @throws InputError naming the file when it cannot be read or does not have nx x ny cells.
bool read_band(const std::string& file, const std::string& name, int nx, int ny,
               const std::function<void(int iy, std::span<const float> values)>& take);

}  // namespace navvy::heightfield
