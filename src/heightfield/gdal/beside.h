// SPDX-License-Identifier: Apache-2.0
// Finds the files that belong to a map file.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// Returns the names, without folder, of the files that may be read together with the map `file`:
/// itself, its projection, its world file and its metadata. GDAL receives this list and looks for
/// no other files. All are plain files of bounded size.
/// @throws FileError naming a file that is not.
std::vector<std::string> files_beside(const std::string& file);

}  // namespace navvy::heightfield
