// SPDX-License-Identifier: Apache-2.0
// Writes the terrain of a world to files.
#pragma once

#include <string>

#include "sim/world.h"

namespace navvy::record {

/// Writes the present heights of the whole site, with the soil that rests on the columns, as a
/// float32 GeoTIFF in the coordinates and datum of its source. While soil is active, a second band
/// `loose_depth` gives the part of the height that consists of particles [m]. Atomic.
/// @throws FileError, also in a build without GDAL.
void write_terrain(const sim::World& world, const std::string& path);

}  // namespace navvy::record
