// SPDX-License-Identifier: Apache-2.0
// Ground as ESRI ASCII grid; needs no GDAL.
#pragma once

#include <string>

#include "heightfield/terrain.h"

namespace navvy::heightfield {

/// Writes the present heights of the whole site, north row first, in the coordinates, units and
/// datum of the file the site came from; every float reads back to the same bits. The format holds
/// no CRS. Atomic.
/// @throws FileError naming path and cause.
void write_esri_ascii(const Terrain& terrain, const std::string& path);

}  // namespace navvy::heightfield
