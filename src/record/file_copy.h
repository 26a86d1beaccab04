// SPDX-License-Identifier: Apache-2.0
// Copies results out of a folder that was removed while they were being written.
#pragma once

#include <string>

namespace navvy::record {

/// Copies the content of the open file `from`, which may have lost its name, to a new file at
/// `path`. Opens that file for reading and writing, with the further `flags` of open(2), and
/// returns its descriptor. `from` stays open and keeps its position.
/// @throws FileError if a file of that name exists, or if reading or writing fails
int copy_to_new_file(int from, const std::string& path, int flags);

}  // namespace navvy::record
