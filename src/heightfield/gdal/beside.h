// SPDX-License-Identifier: Apache-2.0
// The files beside a map that say more of it.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// Names, without their folder, of the files that may be read together with the map `file`: itself,
/// its projection, its world file and its metadata. GDAL is told these and looks for no others. All
/// are plain files of a bounded size.
/// @throws FileError naming the file that is not.
std::vector<std::string> files_beside(const std::string& file);

}  // namespace navvy::heightfield
