// SPDX-License-Identifier: Apache-2.0
// Terrain of a world as files.
#pragma once

#include <string>

#include "sim/world.h"

namespace navvy::record {

/// Writes the present heights of the whole site, columns and the soil that lies on them, as float32
/// GeoTIFF in the source's coordinates and datum. While soil is awake a second band, `loose_depth`,
/// says how much of the height is soil that may still move [m]. Atomic.
/// @throws FileError, also in a build without GDAL.
void write_terrain(const sim::World& world, const std::string& path);

}  // namespace navvy::record
