// SPDX-License-Identifier: Apache-2.0
// Files of soils, buckets and presets of sensors, which scenes name.
#pragma once

#include <string>
#include <vector>

namespace navvy::scene_io {

/// Returns the sorted names, without ".sdf", of the files in `folder`, such as "buckets", of all
/// data directories.
std::vector<std::string> shipped_files(const std::string& folder);

/// Returns the path of the file that `ref` names: a path that ends in .sdf counts from `directory`;
/// any other name is that of a file in `folder` of a data directory. Returns an empty text for a
/// name that is not shipped.
std::string data_file(const std::string& directory, const std::string& ref,
                      const std::string& folder);

}  // namespace navvy::scene_io
