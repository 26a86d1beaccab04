// SPDX-License-Identifier: Apache-2.0
// Reads mesh files of every format, chosen by the ending of the name.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Returns the endings of the mesh files that `read_mesh` reads, in small letters, with their dot.
const std::vector<std::string>& mesh_endings();

/// Returns true if the name of a file ends in one of `mesh_endings`, in small or large letters.
bool is_mesh_file(const std::string& path);

/// Returns the mesh in a file, in the file's own axes with lengths in metres (a Collada file states
/// its unit), and with its colors. Only the axes of glTF are turned, whose standard fixes y up: z
/// becomes the vertical. Groups, nodes and instances are merged into one mesh; vertices of OBJ
/// files stay as they are in the file, those of other formats are merged where they are equal. May
/// be called from several threads.
/// @throws FileError if the file cannot be read
/// @throws InputError naming file, line where the format has lines, value and rule, for a broken or
/// truncated file, one without triangles, and one that exceeds the limits of core/limits.h
TriangleMesh read_mesh(const std::string& path);

}  // namespace navvy::geometry
