// SPDX-License-Identifier: Apache-2.0
// Writes the terrain of a world to files.
#pragma once

#include <string>

#include "sim/world.h"

namespace navvy::record {

/// Writes the current heights of the whole site to the file `path`, a GeoTIFF with float32 values
/// in metres. Heights include the loose soil that rests on the columns. Coordinates and height
/// datum are those of the scene's map, if it has one. While soil is active, a second band
/// `loose_depth` holds the part of each height that consists of particles [m]. The file is replaced
/// as a whole or not at all.
/// @throws FileError if the file cannot be written or Navvy was built without GDAL.
void write_terrain(const sim::World& world, const std::string& path);

}  // namespace navvy::record
