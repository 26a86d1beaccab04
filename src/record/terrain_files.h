// SPDX-License-Identifier: Apache-2.0
// Terrain of a world as files.
#pragma once

#include <string>

#include "heightfield/ground.h"

namespace navvy::record {

/// Writes the present heights of the whole site as float32 GeoTIFF in the source's coordinates and datum. Atomic.
/// @throws FileError, also in a build without GDAL.
void write_terrain(const heightfield::Ground& ground, const std::string& path);

}  // namespace navvy::record
