// SPDX-License-Identifier: Apache-2.0
// Finds the additional files that belong to a map file.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// Returns the names, without folder, of the files that may be read to open the map `file`: the
/// file itself, and those in its folder that hold its projection, world file or metadata. GDAL
/// receives this list and looks for no other files.
/// @throws FileError naming an additional file that is not a plain file or is too large.
std::vector<std::string> files_beside(const std::string& file);

}  // namespace navvy::heightfield
