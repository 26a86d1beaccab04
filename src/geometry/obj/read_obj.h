// SPDX-License-Identifier: Apache-2.0
// Reads Wavefront OBJ files.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// The mesh of an OBJ file, in the file's own frame [m], with the materials of its MTL files.
///
/// All vertices stay, in the file's order and in single precision, whether a face uses them or not;
/// shells, pictures and collision hulls thus see the same points. Faces of more than three corners
/// are cut into triangles; groups and objects are not kept apart, lines and loose points are left
/// out. Normals and texture places are not read. An MTL file that is missing is told as a warning
/// in the log; its faces have no material then.
/// @throws FileError when the file cannot be read; InputError naming file and line for a vertex
/// that is not three finite numbers and a face that has fewer than three corners or names a vertex
/// that does not exist, or for a file beyond 64 MB.
TriangleMesh read_obj(const std::string& path);

}  // namespace navvy::geometry
