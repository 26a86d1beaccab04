// SPDX-License-Identifier: Apache-2.0
// Reads a mesh in a child process, so that a crash of a library is an error of one file.
#pragma once

#include <functional>
#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Calls `read` in a child process made by fork() and returns its mesh. Libraries that read many
/// formats crash on some damaged files; then only the child ends.
/// @param path name of the file, for messages
/// @param library name of the library that `read` calls, for messages
/// @throws what `read` throws: InputError as it is, any other exception as an InputError with its
/// text; InputError if the child crashes; Error if no child can be made, or
/// somebody ends it
TriangleMesh read_in_child(const std::string& path, const std::string& library,
                           const std::function<TriangleMesh()>& read);

}  // namespace navvy::geometry
